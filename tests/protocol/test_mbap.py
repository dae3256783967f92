import pytest

from gripperd.errors import BadReply, DeviceRefused
from gripperd.protocol.mbap import HEADER, ModbusTcp
from gripperd.protocol.modbus import Read, Refusal, Table, Write

octets = bytes.fromhex
LINE = ModbusTcp()
WRITE = Write(1, 0, (10_700,))


def tcp(pdu: str, *, transaction: int = 1, unit: int = 1) -> bytes:
    body = bytes([unit]) + octets(pdu)
    return transaction.to_bytes(2, "big") + b"\0\0" + len(body).to_bytes(2) + body


def test_10_7_milliamperes_octet_by_octet() -> None:
    frame = octets("00 01 00 00 00 06 01 06 00 00 29 cc")
    assert LINE.encode(WRITE, 1) == frame
    assert LINE.decode(WRITE, 1, frame) == (10_700,)
    assert LINE.decode_request(frame) == WRITE
    assert LINE.encode_reply(frame, WRITE) == frame


def test_the_example_of_the_messaging_guide() -> None:
    # MODBUS Messaging on TCP/IP V1.0b builds it: read register 5 of unit 0xFF
    # in transaction 0x1501, and its reply.
    request = Read(0xFF, Table.HOLDING, 4, 1)
    asked = octets("15 01 00 00 00 06 ff 03 00 04 00 01")
    answered = octets("15 01 00 00 00 05 ff 03 02 00 05")
    assert LINE.encode(request, 0x1501) == asked
    assert LINE.encode_reply(asked, request, (5,)) == answered
    assert LINE.decode(request, 0x1501, answered) == (5,)


@pytest.mark.parametrize(
    "lie",
    [
        pytest.param(tcp("06 00 00 29 cc", transaction=2), id="other transaction"),
        pytest.param(tcp("06 00 00 29 cc", transaction=257), id="in its high octet"),
        pytest.param(tcp("06 00 00 29 cc", unit=2), id="other unit"),
        pytest.param(tcp("86 02", transaction=2), id="exception to another request"),
        pytest.param(tcp("86 02", unit=2), id="exception of another unit"),
        pytest.param(tcp("06 00 00 29 cd"), id="other value"),
        pytest.param(tcp("06 00 00 29 cc") + b"\0", id="trailing octet"),
        pytest.param(tcp("06 00 00 29 cc")[:-1], id="an octet missing"),
        pytest.param(octets("00 01 00 01 00 06 01 06 00 00 29 cc"), id="protocol"),
        pytest.param(octets("00 01 00 00 00 07 01 06 00 00 29 cc"), id="length"),
        pytest.param(tcp(""), id="no function"),
        pytest.param(b"", id="nothing"),
        pytest.param(bytes(70_000), id="longer than a header can say"),
    ],
)
def test_a_lie_is_not_believed(lie: bytes) -> None:
    with pytest.raises(BadReply, match="not believed"):
        LINE.decode(WRITE, 1, lie)


@pytest.mark.parametrize("code", list(Refusal))
def test_a_refusal_arrives_as_one(code: Refusal) -> None:
    reply = LINE.encode_refusal(LINE.encode(WRITE, 7), code)
    assert LINE.frame_length(WRITE, reply) == 9
    with pytest.raises(DeviceRefused) as refused:
        LINE.decode(WRITE, 7, reply)
    assert refused.value.exception_code == code


def test_a_refusal_carries_transaction_and_unit() -> None:
    asked = tcp("01 04 a1 00 01", transaction=0x1501, unit=0x0A)
    answered = tcp("81 02", transaction=0x1501, unit=0x0A)
    assert LINE.encode_refusal(asked, Refusal.ILLEGAL_ADDRESS) == answered


def test_a_frame_is_complete_with_its_last_octet_and_not_before() -> None:
    frame = LINE.encode(WRITE, 1)
    for cut in range(len(frame)):
        assert LINE.frame_length(WRITE, frame[:cut]) is None
    assert LINE.frame_length(WRITE, frame) == 12
    assert LINE.frame_length(WRITE, frame + b"more") == 12
    assert LINE.request_length(bytearray(frame + frame)) == 12


def test_125_registers_fit_in_a_frame() -> None:
    request = Read(1, Table.INPUT, 0, 125)
    reply = LINE.encode_reply(LINE.encode(request, 1), request, range(125))
    assert LINE.frame_length(request, reply) == len(reply) == 259
    assert LINE.decode(request, 1, reply) == tuple(range(125))


@pytest.mark.parametrize(
    ("length", "frame"), [(2, 8), (254, 260)], ids=["shortest", "longest"]
)
def test_both_ends_of_the_length_are_allowed(length: int, frame: int) -> None:
    stream = b"\0\1\0\0" + length.to_bytes(2) + bytes(300)
    assert LINE.frame_length(WRITE, stream) == frame


@pytest.mark.parametrize(
    "header",
    [
        pytest.param("00 01 00 01 00 06 01", id="other protocol"),
        pytest.param("00 01 00 00 00 01 01", id="no function"),
        pytest.param("00 01 00 00 00 ff 01", id="longer than any frame"),
        pytest.param("48 54 54 50 2f 31 2e", id="HTTP"),
    ],
)
def test_what_is_not_modbus_cannot_be_followed(header: str) -> None:
    assert len(octets(header)) == HEADER
    with pytest.raises(BadReply, match="not a Modbus TCP header"):
        LINE.frame_length(WRITE, octets(header))
