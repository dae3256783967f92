import pytest

from gripperd.errors import BadReply, DeviceRefused
from gripperd.protocol.modbus import (
    HEADER,
    Read,
    Refusal,
    Request,
    Table,
    Write,
    decode_reply,
    decode_request,
    encode_refusal,
    encode_reply,
    encode_request,
    frame_length,
    transaction_of,
)

WRITE = Write(1, 0, (10_700,))
READ = Read(1, Table.HOLDING, 0x6B, 3)


def octets(text: str) -> bytes:
    return bytes.fromhex(text)


def tcp(pdu: str, *, transaction: int = 1, unit: int = 1) -> bytes:
    body = bytes([unit]) + octets(pdu)
    return transaction.to_bytes(2, "big") + b"\0\0" + len(body).to_bytes(2) + body


EXAMPLES = [
    # Worked examples of the MODBUS Application Protocol V1.1b3.
    pytest.param(
        Read(1, Table.HOLDING, 0x6B, 3),
        (0x022B, 0x0000, 0x0064),
        "03 00 6b 00 03",
        "03 06 02 2b 00 00 00 64",
        id="read holding registers, 6.3",
    ),
    pytest.param(
        Read(1, Table.INPUT, 0x08, 1),
        (0x000A,),
        "04 00 08 00 01",
        "04 02 00 0a",
        id="read input registers, 6.4",
    ),
    pytest.param(
        Write(1, 0x01, (3,)),
        (3,),
        "06 00 01 00 03",
        "06 00 01 00 03",
        id="write single register, 6.6",
    ),
    pytest.param(
        Write(1, 0x01, (0x000A, 0x0102)),
        (0x000A, 0x0102),
        "10 00 01 00 02 04 00 0a 01 02",
        "10 00 01 00 02",
        id="write multiple registers, 6.12",
    ),
    # Waveshare, Modbus RTU Analog Output 8CH: 1 mA on channel 1 is 01 06 00 00 03 E8.
    pytest.param(
        Write(1, 0, (1000,)),
        (1000,),
        "06 00 00 03 e8",
        "06 00 00 03 e8",
        id="Waveshare, 1 mA",
    ),
    pytest.param(
        WRITE,
        (10_700,),
        "06 00 00 29 cc",
        "06 00 00 29 cc",
        id="10.7 mA",
    ),
]


@pytest.mark.parametrize(("request_", "values", "asked", "answered"), EXAMPLES)
def test_examples_of_the_specification_in_both_directions(
    request_: Request, values: tuple[int, ...], asked: str, answered: str
) -> None:
    assert encode_request(request_, 1) == tcp(asked)
    assert decode_request(tcp(asked)) == request_
    assert encode_reply(request_, 1, values) == tcp(answered)
    assert decode_reply(request_, 1, tcp(answered)) == values


def test_10_7_milliamperes_octet_by_octet() -> None:
    frame = octets("00 01 00 00 00 06 01 06 00 00 29 cc")
    assert encode_request(WRITE, 1) == frame
    assert decode_reply(WRITE, 1, frame) == (10_700,)


def test_the_header_carries_transaction_and_unit() -> None:
    frame = encode_request(Write(0xF7, 0, (1,)), 0x1501)
    assert frame[:HEADER] == octets("15 01 00 00 00 06 f7")
    assert transaction_of(frame) == 0x1501


@pytest.mark.parametrize(
    "lie",
    [
        pytest.param(tcp("06 00 00 29 cc", transaction=2), id="other transaction"),
        pytest.param(tcp("06 00 00 29 cc", unit=2), id="other unit"),
        pytest.param(tcp("03 02 29 cc"), id="other function"),
        pytest.param(tcp("10 00 00 00 01"), id="function 16"),
        pytest.param(tcp("06 00 00 29 cd"), id="other value"),
        pytest.param(tcp("06 00 01 29 cc"), id="other address"),
        pytest.param(tcp("06 00 00 29"), id="short"),
        pytest.param(tcp("06"), id="function only"),
        pytest.param(tcp("06 00 00 29 cc 00"), id="long"),
        pytest.param(tcp("86"), id="exception without a code"),
        pytest.param(tcp("86 02 00"), id="long exception"),
        pytest.param(tcp("83 02"), id="exception to another function"),
        pytest.param(tcp("86 02", transaction=2), id="exception to another request"),
        pytest.param(tcp("86 02", unit=2), id="exception of another unit"),
    ],
)
def test_a_lie_about_a_write_is_not_believed(lie: bytes) -> None:
    with pytest.raises(BadReply, match="not believed"):
        decode_reply(WRITE, 1, lie)


@pytest.mark.parametrize(
    "lie",
    [
        pytest.param(tcp("03 06 02 2b 00 00 00 64", transaction=2), id="transaction"),
        pytest.param(tcp("03 06 02 2b 00 00 00 64", unit=17), id="unit"),
        pytest.param(tcp("04 06 02 2b 00 00 00 64"), id="other table"),
        pytest.param(tcp("03 02 02 2b"), id="one register of three"),
        pytest.param(tcp("03 08 02 2b 00 00 00 64 00 00"), id="four registers"),
        pytest.param(tcp("03 06 02 2b 00 00 00"), id="short"),
        pytest.param(tcp("03 06 02 2b 00 00 00 64 00"), id="long"),
        pytest.param(tcp("03 04 02 2b 00 00 00 64"), id="byte count too low"),
        pytest.param(tcp("03 08 02 2b 00 00 00 64"), id="byte count too high"),
        pytest.param(tcp("03 00"), id="nothing"),
        pytest.param(tcp("03"), id="function only"),
        pytest.param(tcp("06 00 6b 00 03"), id="a write echo of the same length"),
    ],
)
def test_a_lie_about_a_read_is_not_believed(lie: bytes) -> None:
    with pytest.raises(BadReply, match="not believed"):
        decode_reply(READ, 1, lie)


@pytest.mark.parametrize(
    "lie", ["10 00 01 00 03", "10 00 02 00 02", "10 00 01 00 02 04", "10 00 01"]
)
def test_a_lie_about_a_write_of_several_is_not_believed(lie: str) -> None:
    with pytest.raises(BadReply, match="its echo differs"):
        decode_reply(Write(1, 1, (10, 258)), 1, tcp(lie))


@pytest.mark.parametrize(
    ("code", "words"),
    [
        (1, "illegal function"),
        (2, "illegal address"),
        (3, "illegal value"),
        (4, "device failure"),
        (11, "no response"),
        (99, "an exception outside the standard"),
    ],
)
def test_an_exception_is_a_refusal_and_says_why(code: int, words: str) -> None:
    with pytest.raises(DeviceRefused, match=words) as refused:
        decode_reply(WRITE, 1, tcp(f"86 {code:02x}"))
    assert refused.value.exception_code == code
    assert "write 10700 to holding register 0 of unit 1" in str(refused.value)


@pytest.mark.parametrize("code", list(Refusal))
def test_a_refusal_arrives_as_one(code: Refusal) -> None:
    asked = encode_request(READ, 7)
    with pytest.raises(DeviceRefused) as refused:
        decode_reply(READ, 7, encode_refusal(asked, code))
    assert refused.value.exception_code == code


def test_the_spec_example_of_an_exception() -> None:
    # [1] section 7: a request for an address that does not exist.
    asked = tcp("01 04 a1 00 01", unit=0x0A)
    assert encode_refusal(asked, Refusal.ILLEGAL_ADDRESS) == tcp("81 02", unit=0x0A)


@pytest.mark.parametrize(
    ("asked", "refusal"),
    [
        ("01 00 00 00 01", Refusal.ILLEGAL_FUNCTION),
        ("2b 0e 01 00", Refusal.ILLEGAL_FUNCTION),
        ("83 02", Refusal.ILLEGAL_FUNCTION),
        ("03", Refusal.ILLEGAL_VALUE),
        ("03 00 00 00", Refusal.ILLEGAL_VALUE),
        ("03 00 00 00 00", Refusal.ILLEGAL_VALUE),
        ("03 00 00 00 7e", Refusal.ILLEGAL_VALUE),
        ("10 00 00 00 00 00", Refusal.ILLEGAL_VALUE),
        ("10 00 00 00 02 04 00 01", Refusal.ILLEGAL_VALUE),
        ("10 00 00 00 02 02 00 01 00 01", Refusal.ILLEGAL_VALUE),
        ("10 00 00 00 01 02 00 01 00", Refusal.ILLEGAL_VALUE),
    ],
)
def test_a_server_refuses_what_it_cannot_do(asked: str, refusal: Refusal) -> None:
    assert decode_request(tcp(asked)) == refusal


@pytest.mark.parametrize("asked", ["06 00 00 29 cc 00 00", "03 00 00 00 01 ff"])
def test_a_request_with_octets_to_spare_is_refused(asked: str) -> None:
    assert decode_request(tcp(asked)) == Refusal.ILLEGAL_VALUE


def test_125_registers_is_the_most_that_can_be_read() -> None:
    request = Read(1, Table.INPUT, 0, 125)
    assert decode_request(encode_request(request, 1)) == request
    reply = encode_reply(request, 1, tuple(range(125)))
    assert frame_length(reply) == 259
    assert decode_reply(request, 1, reply) == tuple(range(125))


def test_a_frame_is_measured_from_its_header_alone() -> None:
    frame = encode_request(WRITE, 1)
    assert [frame_length(frame[:n]) for n in range(HEADER)] == [None] * HEADER
    assert frame_length(frame[:HEADER]) == frame_length(frame + b"more") == 12


@pytest.mark.parametrize(
    ("length", "frame"), [(2, 8), (254, 260)], ids=["shortest", "longest"]
)
def test_both_ends_of_the_length_are_allowed(length: int, frame: int) -> None:
    assert frame_length(b"\0\1\0\0" + length.to_bytes(2) + b"\1") == frame


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
    with pytest.raises(BadReply, match="not a Modbus TCP header"):
        frame_length(octets(header))
