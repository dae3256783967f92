"""Modbus RTU: PDUs between a unit number and a checksum, both halves.

References
----------
.. [1] MODBUS over Serial Line Specification and Implementation Guide V1.02.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from gripperd.errors import BadReply, InputError
from gripperd.protocol import pdu
from gripperd.protocol.disbelief import not_believed
from gripperd.protocol.half_duplex import HalfDuplex
from gripperd.protocol.modbus import (
    WRITE_REGISTER,
    WRITE_REGISTERS,
    Read,
    Refusal,
    Request,
)

AROUND = 3
"""Octets around a PDU: the unit before it, the checksum behind it."""

SHORTEST = 4
LONGEST = 256
"""Octets of the shortest and the longest frame ([1], section 2.5.1)."""

_FIXED = range(1, WRITE_REGISTER + 1)
"""Functions whose requests have eight octets."""
_COUNTED = {15: 6, WRITE_REGISTERS: 6, 23: 10}
"""Functions whose requests count the octets of their values, and where they do."""


def silence(baud: int) -> float:
    """Pause that ends a frame: 3.5 characters of eleven bits, at least 1.75 ms. [s].

    [1], section 2.5.1.1; the least value is meant for lines above 19200 Bd.

    >>> silence(9600)
    0.00401
    >>> silence(115200)
    0.00175
    """
    return max(3.5 * 11 / baud, 1.75e-3)


def _table() -> tuple[int, ...]:
    remainders = []
    for octet in range(256):
        crc = octet
        for _ in range(8):
            crc = (crc >> 1) ^ (0xA001 if crc & 1 else 0)
        remainders.append(crc)
    return tuple(remainders)


_REMAINDERS = _table()


def crc(octets: bytes | bytearray) -> int:
    """Checksum, sent low octet first; that of a sound frame with its own is 0.

    Reflected polynomial 0xA001, preset 0xFFFF ([1], section 6.2.2).
    """
    remainder = 0xFFFF
    for octet in octets:
        remainder = remainder >> 8 ^ _REMAINDERS[(remainder ^ octet) & 0xFF]
    return remainder


@dataclass(frozen=True, slots=True, kw_only=True)
class ModbusRtu(HalfDuplex[Request, tuple[int, ...]]):
    """Frames of Modbus RTU.

    Nothing in a frame ties a reply to its request. A late reply to another read of
    the same unit, function and count, or to the same write, cannot be told from the
    right one: whoever owns the line must let it fall silent before asking again. For
    the same reason a write by function 6 is confirmed by its own echo, unless the
    write asks for function 16.
    """

    def encode(self, request: Request, sequence: int) -> bytes:
        """Frame of a request; the line carries no `sequence`.

        Raises
        ------
        InputError
            Unit 0 is a broadcast: every unit obeys it and none answers.
        """
        if request.unit == 0:
            message = "unit 0 means every unit of a serial line: use 1 to 255"
            raise InputError(message, key="unit")
        return _frame(request.unit, pdu.encode_request(request))

    def _reply_length(self, request: Request, buffer: bytes | bytearray) -> int | None:
        if buffer and buffer[0] != request.unit:
            raise not_believed(request, "another unit answers", buffer.hex(" "))
        if len(buffer) < 2:
            return None
        length = _reply_length(request, buffer)
        return length if length <= len(buffer) else None

    def _decode_reply(self, request: Request, frame: bytes) -> tuple[int, ...]:
        if crc(frame) != 0:
            raise not_believed(request, "its checksum is wrong", frame.hex(" "))
        if frame[0] != request.unit:
            raise not_believed(request, "another unit answers", frame.hex(" "))
        return pdu.decode_reply(request, frame[1:-2])

    def request_length(self, buffer: bytes | bytearray) -> int | None:
        """Octets of the request at the start of a buffer, None while incomplete.

        A request of a function that is not known ends where its checksum fits.

        Raises
        ------
        BadReply
            Longer than any frame; follow the stream again after a silence.
        """
        if len(buffer) < SHORTEST:
            return None
        length = _request_length(buffer)
        if (length or len(buffer)) > LONGEST:
            message = f"not a frame of Modbus RTU: {bytes(buffer[:8]).hex(' ')}"
            raise BadReply(message)
        return None if length is None or len(buffer) < length else length

    def decode_request(self, frame: bytes) -> Request | Refusal | None:
        """What a complete frame asks; None where it is damaged and gets no answer.

        A request to unit 0 is for every unit, and none answers it.
        """
        if len(frame) < SHORTEST or crc(frame) != 0:
            return None
        return pdu.decode_request(frame[0], frame[1:-2])

    def encode_reply(
        self, frame: bytes, request: Request, values: Sequence[int] = ()
    ) -> bytes:
        """Answer to the request in a frame; `values` are what a read has found."""
        return _frame(frame[0], pdu.encode_reply(request, values))

    def encode_refusal(self, frame: bytes, refusal: Refusal) -> bytes:
        """Exception reply to the request in a frame."""
        return _frame(frame[0], pdu.encode_refusal(frame[1], refusal))


def _frame(unit: int, body: bytes) -> bytes:
    octets = bytes((unit,)) + body
    return octets + crc(octets).to_bytes(2, "little")


def _reply_length(request: Request, buffer: bytes | bytearray) -> int:
    if buffer[1] == request.function | pdu.EXCEPTION:
        return AROUND + pdu.EXCEPTION_OCTETS
    if buffer[1] != request.function:
        raise not_believed(request, "it answers another function", buffer.hex(" "))
    octets = pdu.reply_octets(request)
    if isinstance(request, Read) and len(buffer) > 2 and buffer[2] != octets - 2:
        raise not_believed(request, "its byte count is wrong", buffer.hex(" "))
    return AROUND + octets


def _request_length(buffer: bytes | bytearray) -> int | None:
    function = buffer[1]
    if function in _FIXED:
        return 8
    if (at := _COUNTED.get(function)) is not None:
        return at + 3 + buffer[at] if len(buffer) > at else None
    # Appending its own checksum brings the checksum to zero.
    remainder = crc(buffer[: SHORTEST - 1])
    for length, octet in enumerate(buffer[SHORTEST - 1 : LONGEST], SHORTEST):
        remainder = remainder >> 8 ^ _REMAINDERS[(remainder ^ octet) & 0xFF]
        if remainder == 0:
            return length
    return None
