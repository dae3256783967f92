"""pymodbus as the second opinion: other authors, the same octets."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pymodbus.framer.base import FramerBase
from pymodbus.framer.rtu import FramerRTU
from pymodbus.framer.socket import FramerSocket
from pymodbus.pdu import DecodePDU, ExceptionResponse, ModbusPDU, bit_message
from pymodbus.pdu import register_message as register

from gripperd.protocol.mbap import ModbusTcp
from gripperd.protocol.modbus import Read, Refusal, Request, Table, Write, WriteCoil
from gripperd.protocol.rtu import ModbusRtu, crc

from .strategies import found, requests

ASK, ANSWER = DecodePDU(is_server=True), DecodePDU(is_server=False)
Framers = tuple[FramerBase, FramerBase]
LINES: list[tuple[ModbusTcp | ModbusRtu, Framers]] = [
    (ModbusTcp(), (FramerSocket(ASK), FramerSocket(ANSWER))),
    (ModbusRtu(), (FramerRTU(ASK), FramerRTU(ANSWER))),
]
lines = st.sampled_from(LINES)

READS: dict[Table, tuple[type[ModbusPDU], type[ModbusPDU]]] = {
    Table.COILS: (bit_message.ReadCoilsRequest, bit_message.ReadCoilsResponse),
    Table.DISCRETE: (
        bit_message.ReadDiscreteInputsRequest,
        bit_message.ReadDiscreteInputsResponse,
    ),
    Table.HOLDING: (
        register.ReadHoldingRegistersRequest,
        register.ReadHoldingRegistersResponse,
    ),
    Table.INPUT: (
        register.ReadInputRegistersRequest,
        register.ReadInputRegistersResponse,
    ),
}


def theirs(
    request: Request, values: tuple[int, ...], transaction: int
) -> tuple[ModbusPDU, ModbusPDU]:
    """The same request and reply, as pymodbus has them."""
    pair = _bare(request, values)
    for message in pair:
        message.dev_id, message.transaction_id = request.unit, transaction
    return pair


def _bare(request: Request, values: tuple[int, ...]) -> tuple[ModbusPDU, ModbusPDU]:
    address, registers = request.address, list(values)
    if isinstance(request, Read):
        asking, answering = READS[request.table]
        asked = asking(address=address, count=request.count)
        if request.table.of_bits:
            return asked, answering(bits=[bool(value) for value in values])
        return asked, answering(registers=registers)
    if isinstance(request, WriteCoil):
        return (
            bit_message.WriteSingleCoilRequest(address=address, bits=[request.on]),
            bit_message.WriteSingleCoilResponse(address=address, bits=[request.on]),
        )
    if request.multiple or len(values) > 1:
        return (
            register.WriteMultipleRegistersRequest(
                address=address, registers=registers
            ),
            register.WriteMultipleRegistersResponse(address=address, count=len(values)),
        )
    return (
        register.WriteSingleRegisterRequest(address=address, registers=registers),
        register.WriteSingleRegisterResponse(address=address, registers=registers),
    )


@given(lines, requests, st.integers(1, 0xFFFF), st.data())
def test_pymodbus_writes_the_same_octets(
    line: tuple[ModbusTcp | ModbusRtu, Framers],
    request: Request,
    transaction: int,
    draw: st.DataObject,
) -> None:
    ours, (asks, answers) = line
    values = draw.draw(found(request))
    asking, answering = theirs(request, values, transaction)
    frame = ours.encode(request, transaction)
    assert frame == asks.buildFrame(asking)
    reply = answers.buildFrame(answering)
    assert ours.encode_reply(frame, request, values) == reply
    assert ours.frame_length(request, reply) == len(reply)
    assert ours.decode(request, transaction, reply) == values


@given(lines, requests, st.integers(1, 0xFFFF), st.data())
def test_pymodbus_reads_what_was_meant(
    line: tuple[ModbusTcp | ModbusRtu, Framers],
    request: Request,
    transaction: int,
    draw: st.DataObject,
) -> None:
    ours, (asks, answers) = line
    values = draw.draw(found(request))
    frame = ours.encode(request, transaction)
    used, asked = asks.handleFrame(frame, request.unit, transaction)
    assert used == len(frame)
    assert asked is not None
    assert (asked.function_code, asked.address) == (request.function, request.address)
    if isinstance(request, Write):
        assert tuple(asked.registers) == request.values
    reply = ours.encode_reply(frame, request, values)
    used, answered = answers.handleFrame(reply, request.unit, transaction)
    assert used == len(reply)
    assert answered is not None
    if isinstance(request, Read) and request.table.of_bits:
        assert tuple(map(int, answered.bits[: request.count])) == values
    elif isinstance(request, Read):
        assert tuple(answered.registers) == values


@pytest.mark.parametrize("line", LINES)
@pytest.mark.parametrize("refusal", list(Refusal))
def test_pymodbus_refuses_in_the_same_octets(
    line: tuple[ModbusTcp | ModbusRtu, Framers], refusal: Refusal
) -> None:
    ours, (_, answers) = line
    asked = ours.encode(Read(7, Table.INPUT, 0, 8), 9)
    refused = ExceptionResponse(4, refusal)
    refused.dev_id, refused.transaction_id = 7, 9
    assert ours.encode_refusal(asked, refusal) == answers.buildFrame(refused)


@given(st.binary(max_size=256))
def test_pymodbus_finds_the_same_checksum(octets: bytes) -> None:
    assert crc(octets).to_bytes(2, "little") == FramerRTU.compute_CRC(octets).to_bytes(
        2
    )
