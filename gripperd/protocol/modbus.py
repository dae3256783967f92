"""Modbus TCP frames, both halves: requests and the replies that answer them.

pymodbus builds and parses the PDUs and the MBAP header; it is imported nowhere else.
What it accepts without a word, a wrong echo, a short reply, is checked here.

References
----------
.. [1] MODBUS Application Protocol Specification V1.1b3.
.. [2] MODBUS Messaging on TCP/IP Implementation Guide V1.0b, section 3.1.3.
"""

from dataclasses import dataclass
from enum import IntEnum
from typing import TypeAlias

from pymodbus.framer.socket import FramerSocket
from pymodbus.pdu import DecodePDU, ExceptionResponse, ModbusPDU
from pymodbus.pdu.register_message import (
    ReadHoldingRegistersRequest,
    ReadHoldingRegistersResponse,
    ReadInputRegistersRequest,
    ReadInputRegistersResponse,
    WriteMultipleRegistersRequest,
    WriteMultipleRegistersResponse,
    WriteSingleRegisterRequest,
    WriteSingleRegisterResponse,
)

from gripperd.errors import BadReply, DeviceRefused

HEADER = 7
"""Octets of the MBAP header: transaction, protocol, length, unit."""

LONGEST_FRAME = 260
"""Octets of the longest frame, header included ([2], section 4.3.2)."""


class Table(IntEnum):
    """Which registers are read; the value is the function code ([1], section 6)."""

    HOLDING = 3
    INPUT = 4


class Refusal(IntEnum):
    """Exception codes ([1], section 7)."""

    ILLEGAL_FUNCTION = 1
    ILLEGAL_ADDRESS = 2
    ILLEGAL_VALUE = 3
    DEVICE_FAILURE = 4
    ACKNOWLEDGE = 5
    BUSY = 6
    MEMORY_PARITY = 8
    NO_PATH = 10
    NO_RESPONSE = 11


@dataclass(frozen=True, slots=True)
class Read:
    """Read consecutive registers, at most 125."""

    unit: int
    table: Table
    address: int
    count: int = 1

    def __str__(self) -> str:
        """As a person would say it."""
        return (
            f"read {self.count} {self.table.name.lower()} register(s)"
            f" at {self.address} of unit {self.unit}"
        )


@dataclass(frozen=True, slots=True)
class Write:
    """Write consecutive holding registers: function 6 for one, 16 for more."""

    unit: int
    address: int
    values: tuple[int, ...]

    def __str__(self) -> str:
        """As a person would say it."""
        values = ", ".join(map(str, self.values))
        return f"write {values} to holding register {self.address} of unit {self.unit}"


Request: TypeAlias = Read | Write

_requests = FramerSocket(DecodePDU(is_server=True))
_replies = FramerSocket(DecodePDU(is_server=False))


def frame_length(buffer: bytes | bytearray) -> int | None:
    """Octets of the first frame in a buffer, None while its header is incomplete.

    Raises
    ------
    BadReply
        The header is not one of Modbus TCP; the stream cannot be followed further.
    """
    if len(buffer) < HEADER:
        return None
    protocol = int.from_bytes(buffer[2:4], "big")
    length = int.from_bytes(buffer[4:6], "big") + 6
    if protocol != 0 or not HEADER < length <= LONGEST_FRAME:
        message = f"not a Modbus TCP header: {bytes(buffer[:HEADER]).hex(' ')}"
        raise BadReply(message)
    return length


def transaction_of(frame: bytes) -> int:
    """Transaction identifier of a complete frame."""
    return int.from_bytes(frame[:2], "big")


def encode_request(request: Request, transaction: int) -> bytes:
    """Frame of a request."""
    pdu: ModbusPDU
    match request:
        case Read(unit, Table.HOLDING, address, count):
            pdu = ReadHoldingRegistersRequest(dev_id=unit, address=address, count=count)
        case Read(unit, _, address, count):
            pdu = ReadInputRegistersRequest(dev_id=unit, address=address, count=count)
        case Write(unit, address, (value,)):
            pdu = WriteSingleRegisterRequest(
                dev_id=unit, address=address, registers=[value]
            )
        case Write(unit, address, values):
            pdu = WriteMultipleRegistersRequest(
                dev_id=unit, address=address, registers=list(values)
            )
    pdu.transaction_id = transaction
    return _requests.buildFrame(pdu)


def decode_reply(request: Request, transaction: int, frame: bytes) -> tuple[int, ...]:
    """Believe a reply only if it answers the request.

    Parameters
    ----------
    request, transaction
        What was asked.
    frame
        One complete frame, as measured by :func:`frame_length`.

    Returns
    -------
    The registers read, or written.

    Raises
    ------
    BadReply
        Other transaction, unit, function, length, address or echo.
    DeviceRefused
        A well-formed exception reply.
    """
    wanted = encode_request(request, transaction)
    if frame[:2] != wanted[:2] or frame[6] != wanted[6]:
        raise _bad(request, frame, "it belongs to another transaction or unit")
    if frame[7] == wanted[7] | 0x80 and len(frame) == HEADER + 2:
        raise _refused(request, frame[8])
    if frame[7] != wanted[7]:
        raise _bad(request, frame, f"it answers function {frame[7]}")
    if isinstance(request, Write):
        # Function 6 echoes the request; function 16 its address and count.
        echo = (
            wanted if len(request.values) == 1 else wanted[:4] + b"\0\6" + wanted[6:12]
        )
        if frame != echo:
            raise _bad(request, frame, "its echo differs")
        return request.values
    if len(frame) != HEADER + 2 + 2 * request.count or frame[8] != 2 * request.count:
        raise _bad(request, frame, "it holds another number of registers")
    _, pdu = _replies.handleFrame(frame, request.unit, transaction)
    if pdu is None:
        raise _bad(request, frame, "it cannot be decoded")
    return tuple(pdu.registers)


def decode_request(frame: bytes) -> Request | Refusal:
    """What a client asks of a server; :class:`Refusal` where it asks too much."""
    function = frame[7]
    if function not in {Table.HOLDING, Table.INPUT, 6, 16}:
        return Refusal.ILLEGAL_FUNCTION
    if len(frame) < HEADER + 5 or (function != 16 and len(frame) != HEADER + 5):
        return Refusal.ILLEGAL_VALUE
    unit = frame[6]
    address = int.from_bytes(frame[8:10], "big")
    pdu = _requests.decoder.decode(frame[7:])
    if function == 6 and pdu is not None:
        return Write(unit, address, (pdu.registers[0],))
    count = int.from_bytes(frame[10:12], "big")
    if pdu is None or not 1 <= count <= 125:
        return Refusal.ILLEGAL_VALUE
    if function != 16:
        return Read(unit, Table(function), address, count)
    if len(frame) != HEADER + 6 + 2 * count or frame[12] != 2 * count:
        return Refusal.ILLEGAL_VALUE
    return Write(unit, address, tuple(pdu.registers))


def encode_reply(
    request: Request, transaction: int, values: tuple[int, ...] = ()
) -> bytes:
    """Frame that answers a request; ``values`` are the registers of a read."""
    pdu: ModbusPDU
    registers = list(values)
    match request:
        case Read(unit, Table.HOLDING):
            pdu = ReadHoldingRegistersResponse(dev_id=unit, registers=registers)
        case Read(unit, _):
            pdu = ReadInputRegistersResponse(dev_id=unit, registers=registers)
        case Write(unit, address, (value,)):
            pdu = WriteSingleRegisterResponse(
                dev_id=unit, address=address, registers=[value]
            )
        case Write(unit, address, written):
            pdu = WriteMultipleRegistersResponse(
                dev_id=unit, address=address, count=len(written)
            )
    pdu.transaction_id = transaction
    return _replies.buildFrame(pdu)


def encode_refusal(frame: bytes, refusal: Refusal) -> bytes:
    """Exception reply to the request in a frame."""
    pdu = ExceptionResponse(frame[7], refusal)
    pdu.dev_id, pdu.transaction_id = frame[6], transaction_of(frame)
    return _replies.buildFrame(pdu)


def _bad(request: Request, frame: bytes, why: str) -> BadReply:
    return BadReply(f"a reply to '{request}' is not believed: {why} ({frame.hex(' ')})")


def _refused(request: Request, code: int) -> DeviceRefused:
    try:
        word = Refusal(code).name.lower().replace("_", " ")
    except ValueError:
        word = "an exception outside the standard"
    message = f"the device refuses to {request}: {word} (exception {code})"
    return DeviceRefused(message, exception_code=code)
