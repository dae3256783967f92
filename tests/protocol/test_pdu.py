"""Examples are those of the MODBUS Application Protocol V1.1b3, by section."""

import pytest

from gripperd.errors import BadReply, DeviceRefused
from gripperd.protocol.modbus import Read, Refusal, Request, Table, Write, WriteCoil
from gripperd.protocol.pdu import (
    decode_reply,
    decode_request,
    encode_refusal,
    encode_reply,
    encode_request,
    reply_octets,
)

octets = bytes.fromhex
WRITE = Write(1, 0, (10_700,))
READ = Read(1, Table.HOLDING, 0x6B, 3)
BITS = Read(1, Table.COILS, 0x13, 19)

EXAMPLES = [
    pytest.param(
        BITS,
        # CD, 6B, 05: the lowest bit of the first octet is the first coil.
        (1, 0, 1, 1, 0, 0, 1, 1, 1, 1, 0, 1, 0, 1, 1, 0, 1, 0, 1),
        "01 00 13 00 13",
        "01 03 cd 6b 05",
        id="read coils, 6.1",
    ),
    pytest.param(
        Read(1, Table.DISCRETE, 0xC4, 22),
        (0, 0, 1, 1, 0, 1, 0, 1, 1, 1, 0, 1, 1, 0, 1, 1, 1, 0, 1, 0, 1, 1),
        "02 00 c4 00 16",
        "02 03 ac db 35",
        id="read discrete inputs, 6.2",
    ),
    pytest.param(
        READ,
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
        WriteCoil(1, 0xAC, on=True),
        (1,),
        "05 00 ac ff 00",
        "05 00 ac ff 00",
        id="write single coil, 6.5",
    ),
    pytest.param(
        WriteCoil(1, 0xAC, on=False),
        (0,),
        "05 00 ac 00 00",
        "05 00 ac 00 00",
        id="clear a coil, 6.5",
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
    pytest.param(
        Write(1, 0x01, (3,), multiple=True),
        (3,),
        "10 00 01 00 01 02 00 03",
        "10 00 01 00 01",
        id="write one register by function 16",
    ),
    pytest.param(
        WRITE, (10_700,), "06 00 00 29 cc", "06 00 00 29 cc", id="10.7 mA in µA"
    ),
]


@pytest.mark.parametrize(("request_", "values", "asked", "answered"), EXAMPLES)
def test_examples_of_the_specification_in_both_directions(
    request_: Request, values: tuple[int, ...], asked: str, answered: str
) -> None:
    assert encode_request(request_) == octets(asked)
    assert decode_request(1, octets(asked)) == request_
    assert encode_reply(request_, values) == octets(answered)
    assert decode_reply(request_, octets(answered)) == values
    assert reply_octets(request_) == len(octets(answered))


FUNCTION = "it answers another function"
LENGTH = "it has another length"
COUNT = "its byte count is wrong"
ECHO = "its echo differs"
SEVERAL = Write(1, 1, (10, 258))
COIL = WriteCoil(1, 0xAC, on=True)

LIES = [
    (WRITE, "03 02 29 cc", FUNCTION),
    (WRITE, "10 00 00 00 01", FUNCTION),
    (WRITE, "06 00 00 29 cd", ECHO),
    (WRITE, "06 00 01 29 cc", ECHO),
    (WRITE, "06 00 00 29", LENGTH),
    (WRITE, "06 00 00 29 cc 00", LENGTH),
    (WRITE, "06", LENGTH),
    (WRITE, "", FUNCTION),
    # Exceptions without a code, with two, and to another function.
    (WRITE, "86", FUNCTION),
    (WRITE, "86 02 00", FUNCTION),
    (WRITE, "83 02", FUNCTION),
    (SEVERAL, "10 00 01 00 03", ECHO),
    (SEVERAL, "10 00 02 00 02", ECHO),
    (SEVERAL, "10 00 01 00 02 04", LENGTH),
    (SEVERAL, "10 00 01", LENGTH),
    (COIL, "05 00 ac 00 00", ECHO),
    (COIL, "05 00 ad ff 00", ECHO),
    (COIL, "05 00 ac 00 01", ECHO),
    # Another table, one register of three, four, and the echo of a write.
    (READ, "04 06 02 2b 00 00 00 64", FUNCTION),
    (READ, "03 02 02 2b", LENGTH),
    (READ, "03 08 02 2b 00 00 00 64 00 00", LENGTH),
    (READ, "06 00 6b 00 03", FUNCTION),
    (READ, "03 06 02 2b 00 00 00", LENGTH),
    (READ, "03 06 02 2b 00 00 00 64 00", LENGTH),
    (READ, "03 04 02 2b 00 00 00 64", COUNT),
    (READ, "03 08 02 2b 00 00 00 64", COUNT),
    (READ, "03 00", LENGTH),
    (READ, "03", LENGTH),
    (BITS, "01 02 cd 6b", LENGTH),
    (BITS, "01 04 cd 6b 05 00", LENGTH),
    (BITS, "01 02 cd 6b 05", COUNT),
    (BITS, "02 03 cd 6b 05", FUNCTION),
]


@pytest.mark.parametrize(("request_", "lie", "why"), LIES)
def test_a_lie_is_not_believed_and_what_is_wrong_with_it_is_said(
    request_: Request, lie: str, why: str
) -> None:
    with pytest.raises(BadReply, match=f"not believed: {why}"):
        decode_reply(request_, octets(lie))


def test_what_pads_the_last_bits_says_nothing() -> None:
    assert decode_reply(Read(1, Table.COILS, 0, 2), octets("01 01 fe")) == (0, 1)


@pytest.mark.parametrize(
    ("code", "words"),
    [
        (1, "illegal function"),
        (2, "illegal address"),
        (3, "illegal value"),
        (4, "device failure"),
        (6, "busy"),
        (11, "no response"),
        (99, "an exception outside the standard"),
    ],
)
def test_an_exception_is_a_refusal_and_says_why(code: int, words: str) -> None:
    with pytest.raises(DeviceRefused, match=words) as refused:
        decode_reply(WRITE, bytes((0x86, code)))
    assert refused.value.exception_code == code
    assert "write 10700 to holding register 0 of unit 1" in str(refused.value)


def test_the_spec_example_of_an_exception() -> None:
    # Section 7: reading a coil that does not exist.
    assert encode_refusal(0x01, Refusal.ILLEGAL_ADDRESS) == octets("81 02")


@pytest.mark.parametrize(
    ("asked", "refusal"),
    [
        ("07", Refusal.ILLEGAL_FUNCTION),
        ("0f 00 13 00 0a 02 cd 01", Refusal.ILLEGAL_FUNCTION),
        ("2b 0e 01 00", Refusal.ILLEGAL_FUNCTION),
        ("83 02", Refusal.ILLEGAL_FUNCTION),
        ("03", Refusal.ILLEGAL_VALUE),
        ("03 00 00 00", Refusal.ILLEGAL_VALUE),
        ("03 00 00 00 00", Refusal.ILLEGAL_VALUE),
        ("03 00 00 00 7e", Refusal.ILLEGAL_VALUE),
        ("01 00 00 07 d1", Refusal.ILLEGAL_VALUE),
        ("03 00 00 00 01 ff", Refusal.ILLEGAL_VALUE),
        ("05 00 ac 00 01", Refusal.ILLEGAL_VALUE),
        ("05 00 ac ff 00 00", Refusal.ILLEGAL_VALUE),
        ("06 00 00 29 cc 00 00", Refusal.ILLEGAL_VALUE),
        ("10 00 00 00 00 00", Refusal.ILLEGAL_VALUE),
        ("10 00 00 00 01", Refusal.ILLEGAL_VALUE),
        ("10 00 00 00 02 04 00 01", Refusal.ILLEGAL_VALUE),
        ("10 00 00 00 02 02 00 01 00 01", Refusal.ILLEGAL_VALUE),
        ("10 00 00 00 01 02 00 01 00", Refusal.ILLEGAL_VALUE),
        ("10 00 00 00 7c f8" + " 00 00" * 124, Refusal.ILLEGAL_VALUE),
    ],
)
def test_a_server_refuses_what_it_cannot_do(asked: str, refusal: Refusal) -> None:
    assert decode_request(1, octets(asked)) == refusal
