"""Modbus protocol data units: function code and what belongs to it, both halves.

Which unit is meant, and where a unit ends in a stream, is up to the line.

References
----------
.. [1] MODBUS Application Protocol Specification V1.1b3.
"""

import struct
from collections.abc import Sequence

from gripperd.errors import BadReply, DeviceRefused, InputError
from gripperd.protocol.disbelief import not_believed
from gripperd.protocol.modbus import (
    WRITE_COIL,
    WRITE_REGISTER,
    WRITE_REGISTERS,
    Read,
    Refusal,
    Request,
    Table,
    Write,
    WriteCoil,
)

EXCEPTION = 0x80
"""Added to the function code of a request that is refused ([1], section 7)."""

EXCEPTION_OCTETS = 2

SHORT = struct.Struct(">BHH")
"""Function, address and one word: most requests, and every reply to a write."""

ON, OFF = 0xFF00, 0x0000
"""What a coil is told ([1], section 6.5)."""

_REGISTERS = tuple(
    struct.Struct(f">{count}H") for count in range(Table.HOLDING.most + 1)
)
"""What packs so many registers."""
_TABLES = frozenset(map(int, Table))
_FUNCTIONS = _TABLES | {WRITE_COIL, WRITE_REGISTER, WRITE_REGISTERS}


def encode_request(request: Request) -> bytes:
    """PDU of a request."""
    head = _head(request)
    if not isinstance(request, Write) or head[0] == WRITE_REGISTER:
        return head
    count = len(request.values)
    return head + struct.pack(f">B{count}H", 2 * count, *request.values)


def reply_octets(request: Request) -> int:
    """Length of the PDU that grants a request."""
    if not isinstance(request, Read):
        return SHORT.size
    if request.table.of_bits:
        return 2 + (request.count + 7) // 8
    return 2 + 2 * request.count


def decode_reply(request: Request, pdu: bytes) -> tuple[int, ...]:
    """Believe a reply only if it answers the request.

    Returns
    -------
    The registers, or the bits as 0 and 1, that were read or written. What pads the
    last octet of bits is not looked at: it says nothing.

    Raises
    ------
    BadReply
        Other function, length, byte count, address or echo.
    DeviceRefused
        A well-formed exception reply.
    """
    if isinstance(request, Read):
        octets = reply_octets(request)
        if len(pdu) == octets and pdu[0] == request.table and pdu[1] == octets - 2:
            return _read_values(request, pdu)
    elif pdu == _head(request):
        return (int(request.on),) if isinstance(request, WriteCoil) else request.values
    raise _complaint(request, pdu)


def _complaint(request: Request, pdu: bytes) -> DeviceRefused | BadReply:
    """What is wrong with a reply that does not grant a request."""
    if len(pdu) == EXCEPTION_OCTETS and pdu[0] == request.function | EXCEPTION:
        return _refused(request, pdu[1])
    if not pdu or pdu[0] != request.function:
        why = "it answers another function"
    elif len(pdu) != reply_octets(request):
        why = "it has another length"
    elif isinstance(request, Read):
        why = "its byte count is wrong"
    else:
        why = "its echo differs"
    return not_believed(request, why, pdu.hex(" "))


def _read_values(request: Read, pdu: bytes) -> tuple[int, ...]:
    if request.table.of_bits:
        bits = int.from_bytes(pdu[2:], "little")
        return tuple(bits >> place & 1 for place in range(request.count))
    return _REGISTERS[request.count].unpack_from(pdu, 2)


def decode_request(unit: int, pdu: bytes) -> Request | Refusal:
    """What a client asks of a unit; :class:`Refusal` where it asks too much."""
    function = pdu[0]
    if function not in _FUNCTIONS:
        return Refusal.ILLEGAL_FUNCTION
    if len(pdu) < SHORT.size:
        return Refusal.ILLEGAL_VALUE
    _, address, word = SHORT.unpack_from(pdu)
    try:
        if function == WRITE_REGISTERS:
            return _decode_write(unit, address, word, pdu[SHORT.size :])
        if len(pdu) != SHORT.size or (function == WRITE_COIL and word not in {ON, OFF}):
            return Refusal.ILLEGAL_VALUE
        if function in _TABLES:
            return Read(unit, Table(function), address, word)
    except InputError:
        return Refusal.ILLEGAL_VALUE
    if function == WRITE_COIL:
        return WriteCoil(unit, address, word == ON)
    return Write(unit, address, (word,))


def _decode_write(
    unit: int, address: int, count: int, octets: bytes
) -> Write | Refusal:
    if len(octets) != 1 + 2 * count or octets[0] != 2 * count:
        return Refusal.ILLEGAL_VALUE
    values = struct.unpack_from(f">{count}H", octets, 1)
    return Write(unit, address, values, multiple=count == 1)


def encode_reply(request: Request, values: Sequence[int] = ()) -> bytes:
    """PDU that grants a request; `values` are the registers or bits of a read."""
    if not isinstance(request, Read):
        return _head(request)
    octets = reply_octets(request) - 2
    head = bytes((request.function, octets))
    if not request.table.of_bits:
        return head + struct.pack(f">{request.count}H", *values)
    bits = sum(bit << place for place, bit in enumerate(values))
    return head + bits.to_bytes(octets, "little")


def encode_refusal(function: int, refusal: Refusal) -> bytes:
    """PDU that refuses a request."""
    return bytes((function | EXCEPTION, refusal))


def _head(request: Request) -> bytes:
    """Function, address, and a count, a value or a coil's state."""
    if isinstance(request, Read):
        return SHORT.pack(request.table, request.address, request.count)
    if isinstance(request, WriteCoil):
        return SHORT.pack(WRITE_COIL, request.address, ON if request.on else OFF)
    function, values = request.function, request.values
    word = values[0] if function == WRITE_REGISTER else len(values)
    return SHORT.pack(function, request.address, word)


def _refused(request: Request, code: int) -> DeviceRefused:
    try:
        word = Refusal(code).name.lower().replace("_", " ")
    except ValueError:
        word = "an exception outside the standard"
    message = f"the device refuses to {request}: {word} (exception {code})"
    return DeviceRefused(message, exception_code=code)
