"""Modbus TCP: PDUs behind the MBAP header, both halves.

References
----------
.. [1] MODBUS Messaging on TCP/IP Implementation Guide V1.0b, section 3.1.3.
"""

import struct
from collections.abc import Sequence
from dataclasses import dataclass

from gripperd.errors import BadReply
from gripperd.protocol import pdu
from gripperd.protocol.disbelief import not_believed
from gripperd.protocol.modbus import Refusal, Request

HEADER = 7
"""Octets of the header: transaction, protocol, length, unit."""

LONGEST = 260
"""Octets of the longest frame, header included."""

_HEADER = struct.Struct(">HHHB")
_COUNTED_FROM = 6
"""The length in the header counts what follows it: the unit and the PDU."""


@dataclass(frozen=True, slots=True)
class ModbusTcp:
    """Frames of Modbus TCP; a transaction number ties a reply to its request."""

    def encode(self, request: Request, sequence: int) -> bytes:
        """Frame of a request; `sequence` is its transaction number."""
        return _frame(sequence, request.unit, pdu.encode_request(request))

    def frame_length(self, request: Request, buffer: bytes | bytearray) -> int | None:
        """Octets of the reply at the start of a buffer, None while it is incomplete.

        Raises
        ------
        BadReply
            Not a header of Modbus TCP; the stream cannot be followed further.
        """
        return self.request_length(buffer)

    def decode(self, request: Request, sequence: int, frame: bytes) -> tuple[int, ...]:
        """Believe a reply only if it answers the request.

        Raises
        ------
        BadReply
            Other transaction, unit, function, length, address or echo.
        DeviceRefused
            A well-formed exception reply.
        """
        counted = len(frame) - _COUNTED_FROM
        if not HEADER < len(frame) <= LONGEST or not frame.startswith(
            _HEADER.pack(sequence, 0, counted, request.unit)
        ):
            why = "its header is that of another transaction or unit"
            raise not_believed(request, why, frame.hex(" "))
        return pdu.decode_reply(request, frame[HEADER:])

    def request_length(self, buffer: bytes | bytearray) -> int | None:
        """Octets of the request at the start of a buffer, None while incomplete.

        Raises
        ------
        BadReply
            Not a header of Modbus TCP; the stream cannot be followed further.
        """
        if len(buffer) < HEADER:
            return None
        _, protocol, counted, _ = _HEADER.unpack_from(buffer)
        length: int = counted + _COUNTED_FROM
        if protocol != 0 or not HEADER < length <= LONGEST:
            message = f"not a Modbus TCP header: {bytes(buffer[:HEADER]).hex(' ')}"
            raise BadReply(message)
        return length if length <= len(buffer) else None

    def decode_request(self, frame: bytes) -> Request | Refusal:
        """What a complete frame asks; :class:`Refusal` where it asks too much."""
        return pdu.decode_request(frame[HEADER - 1], frame[HEADER:])

    def encode_reply(
        self, frame: bytes, request: Request, values: Sequence[int] = ()
    ) -> bytes:
        """Answer to the request in a frame; `values` are what a read has found."""
        transaction = int.from_bytes(frame[:2], "big")
        return _frame(transaction, request.unit, pdu.encode_reply(request, values))

    def encode_refusal(self, frame: bytes, refusal: Refusal) -> bytes:
        """Exception reply to the request in a frame."""
        transaction, unit = int.from_bytes(frame[:2], "big"), frame[HEADER - 1]
        return _frame(transaction, unit, pdu.encode_refusal(frame[HEADER], refusal))


def _frame(transaction: int, unit: int, body: bytes) -> bytes:
    return _HEADER.pack(transaction, 0, len(body) + 1, unit) + body
