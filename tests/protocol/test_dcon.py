from dataclasses import replace

import pytest

from gripperd.errors import (
    BadReply,
    DeviceRefused,
    InputError,
    LocalEcho,
    WatchdogTripped,
)
from gripperd.protocol.dcon import HOST_OK, Ask, Command, Dcon, Good, Lead, Refusal

LINE = Dcon()
SEALED = Dcon(checksum=True)
ECHOING = Dcon(local_echo=True)

# 10.7 mA on channel 0 of an I-7024 at address 1.
WRITE = Ask(1, "0+10.700")
# The same on an ADAM-4024, which grants with its address.
ADAM = Ask(1, "C0+10.700", good=Good.ADDRESS)
READ = Ask(1, "60", Lead.SETTING, good=Good.ADDRESS, payload=7)


def test_10_7_milliamperes_octet_by_octet() -> None:
    assert LINE.encode(WRITE, 1) == b"#010+10.700\r"
    assert LINE.frame_length(WRITE, b">\r") == 2
    assert LINE.decode(WRITE, 1, b">\r") == ""


@pytest.mark.parametrize(
    ("request_", "line", "reply", "text"),
    [
        (ADAM, b"#01C0+10.700\r", b"!01\r", ""),
        (READ, b"$0160\r", b"!01+10.700\r", "+10.700"),
        (Ask(0xAB, "0", Lead.HOST, Good.ADDRESS, 2), b"~AB0\r", b"!AB04\r", "04"),
        (Ask(1, "", payload=14), b"#01\r", b">+04.000+12.000\r", "+04.000+12.000"),
        (Ask(1, "M", Lead.SETTING, Good.ADDRESS, None), b"$01M\r", b"!01I7\r", "I7"),
    ],
)
def test_each_request_says_what_a_good_reply_is(
    request_: Ask, line: bytes, reply: bytes, text: str
) -> None:
    assert LINE.encode(request_, 1) == line
    assert LINE.frame_length(request_, reply) == len(reply)
    assert LINE.decode(request_, 1, reply) == text
    assert LINE.encode_reply(request_, request_.good, text) == reply


def test_the_host_is_alive_has_no_reply() -> None:
    assert LINE.encode(HOST_OK, 1) == b"~**\r"
    assert LINE.frame_length(HOST_OK, b"") == 0
    assert LINE.decode(HOST_OK, 1, b"") == ""
    with pytest.raises(BadReply):
        LINE.decode(HOST_OK, 1, b">\r")


@pytest.mark.parametrize(
    "lie",
    [
        pytest.param(b">+10.700\r", id="a reading"),
        pytest.param(b"!01\r", id="another kind of grant"),
        pytest.param(b"?02\r", id="refusal of another module"),
        pytest.param(b"> \r", id="trailing blank"),
        pytest.param(b">", id="no end"),
        pytest.param(b"\r", id="an empty line"),
        pytest.param(b">\r\r", id="two ends"),
        pytest.param(b">\xff\r", id="not ASCII"),
        pytest.param(b">\n\r", id="not printable"),
        pytest.param(b">3E\r", id="a checksum that was not asked for"),
        pytest.param(b"", id="nothing"),
    ],
)
def test_a_lie_about_a_write_is_not_believed(lie: bytes) -> None:
    with pytest.raises(BadReply, match="not believed"):
        LINE.decode(WRITE, 1, lie)


@pytest.mark.parametrize(
    "lie", [b"!02+10.700\r", b"!01+10.70\r", b"!01\r", b">+10.700\r", b"!01+10.7000\r"]
)
def test_a_lie_about_a_read_is_not_believed(lie: bytes) -> None:
    with pytest.raises(BadReply, match="not believed"):
        LINE.decode(READ, 1, lie)


@pytest.mark.parametrize("request_", [WRITE, ADAM, READ])
def test_a_tripped_watchdog_is_an_error_of_its_own(request_: Ask) -> None:
    with pytest.raises(WatchdogTripped, match="host watchdog has tripped") as tripped:
        LINE.decode(request_, 1, b"!\r")
    assert tripped.value.exception_code is None


@pytest.mark.parametrize(
    ("reply", "words"), [(b"?01\r", "invalid"), (b"?\r", "out of range")]
)
def test_a_refusal_says_why(reply: bytes, words: str) -> None:
    with pytest.raises(DeviceRefused, match=f"#010\\+10.700.*{words}") as refused:
        LINE.decode(WRITE, 1, reply)
    assert not isinstance(refused.value, WatchdogTripped)


def test_the_checksum_is_the_sum_of_the_characters() -> None:
    # '$012' sums to 0x24 + 0x30 + 0x31 + 0x32 = 0xB7; '!01200600' to 0xAA mod 256:
    # the examples that ICP DAS prints for its I-7000.
    ask = Ask(1, "2", Lead.SETTING, Good.ADDRESS, 6)
    assert SEALED.encode(ask, 1) == b"$012B7\r"
    assert SEALED.decode(ask, 1, b"!01200600AA\r") == "200600"


@pytest.mark.parametrize("reply", [b">\r", b">3F\r", b">3e\r", b"3E\r", b"E\r", b"\r"])
def test_a_wrong_checksum_is_not_believed(reply: bytes) -> None:
    assert SEALED.decode(WRITE, 1, b">3E\r") == ""
    with pytest.raises(BadReply, match="it is damaged"):
        SEALED.decode(WRITE, 1, reply)


def test_refusals_carry_the_checksum_too() -> None:
    with pytest.raises(WatchdogTripped):
        SEALED.decode(WRITE, 1, b"!21\r")
    with pytest.raises(DeviceRefused):
        SEALED.decode(WRITE, 1, b"?01A0\r")


def test_a_line_is_complete_with_its_end_and_not_before() -> None:
    reply = b"!01+10.700\r"
    for cut in range(len(reply)):
        assert LINE.frame_length(READ, reply[:cut]) is None
    assert LINE.frame_length(READ, bytearray(reply + b"!")) == len(reply)


@pytest.mark.parametrize("noise", [b"\xff", b"\0!01\r", b"\r", b"+10.700"])
def test_noise_is_noticed_at_once(noise: bytes) -> None:
    with pytest.raises(BadReply, match="no reply begins so"):
        LINE.frame_length(READ, noise)


@pytest.mark.parametrize("stream", [b">" * 128, b">" * 128 + b"\r"])
def test_a_line_that_does_not_end_cannot_be_followed(stream: bytes) -> None:
    assert LINE.frame_length(READ, stream[:127]) is None
    with pytest.raises(BadReply, match="does not end"):
        LINE.frame_length(READ, stream)
    with pytest.raises(BadReply, match="does not end"):
        LINE.request_length(stream)


def test_an_echo_that_nobody_announced_is_named() -> None:
    echo = b"#010+10.700\r"
    assert LINE.frame_length(WRITE, echo[:4]) is None
    with pytest.raises(LocalEcho, match="set 'local_echo: true'"):
        LINE.frame_length(WRITE, echo + b">\r")
    with pytest.raises(LocalEcho):
        LINE.decode(WRITE, 1, echo)


def test_an_announced_echo_is_taken_off() -> None:
    stream = b"#010+10.700\r>\r"
    assert ECHOING.frame_length(WRITE, stream[:12]) is None
    assert ECHOING.frame_length(WRITE, stream) == 14
    assert ECHOING.decode(WRITE, 1, stream) == ""
    assert ECHOING.frame_length(HOST_OK, b"~**\r") == 4
    assert ECHOING.decode(HOST_OK, 1, b"~**\r") == ""


@pytest.mark.parametrize("unit", [-1, 256])
def test_an_address_of_more_than_two_digits_is_refused(unit: int) -> None:
    with pytest.raises(InputError, match="0 to 255"):
        Ask(unit, "")


@pytest.mark.parametrize("text", ["\r", "0\r#02", "\0", "µA", "\x7f"])
def test_text_that_would_make_another_line_is_refused(text: str) -> None:
    with pytest.raises(InputError, match="only printable ASCII"):
        Ask(1, text)


@pytest.mark.parametrize(
    ("line", "command"),
    [
        (b"#010+10.700\r", Command(1, "0+10.700", Lead.VALUE)),
        (b"$AB2\r", Command(0xAB, "2", Lead.SETTING)),
        (b"~**\r", Command(None, "", Lead.HOST)),
        (b"%0102300600\r", Command(1, "02300600", Lead.CONFIGURE)),
    ],
)
def test_a_module_understands_a_command(line: bytes, command: Command) -> None:
    assert LINE.request_length(line[:-1]) is None
    assert LINE.request_length(line + b"#") == len(line)
    assert LINE.decode_request(line) == command
    assert LINE.encode(command, 1) == line


@pytest.mark.parametrize(
    "line", [b"#1\r", b"#0x1\r", b"#ab\r", b"&01\r", b"\r", b"#01", b"#01\xff\r", b""]
)
def test_a_module_stays_silent_on_a_mistake(line: bytes) -> None:
    assert LINE.decode_request(line) is None


def test_a_module_stays_silent_on_a_wrong_checksum() -> None:
    assert SEALED.decode_request(b"$012B7\r") == Command(1, "2", Lead.SETTING)
    assert SEALED.decode_request(b"$012B8\r") is None
    assert SEALED.decode_request(b"$012\r") is None


@pytest.mark.parametrize(
    ("refusal", "line"),
    [
        (Refusal.INVALID, b"?AB\r"),
        (Refusal.OUT_OF_RANGE, b"?\r"),
        (Refusal.WATCHDOG, b"!\r"),
    ],
)
def test_a_refusal_arrives_as_one(refusal: Refusal, line: bytes) -> None:
    request = replace(WRITE, unit=0xAB)
    assert LINE.encode_refusal(request, refusal) == line
    with pytest.raises(DeviceRefused):
        LINE.decode(request, 1, line)
