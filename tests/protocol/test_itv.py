import pytest

from gripperd.errors import BadReply, DeviceRefused, InputError
from gripperd.protocol.itv import Itv, Query, Refusal, Request, Set

LINE = Itv()


@pytest.mark.parametrize(
    ("request_", "line", "reply", "count"),
    [
        (Set(512), b"SET 512\r\n", b"512\r\n", 512),
        (Set(0), b"SET 0\r\n", b"0\r\n", 0),
        (Set(1023), b"SET 1023\r\n", b"1023\r\n", 1023),
        (Query.PRESSURE, b"MON\r\n", b"509\r\n", 509),
        (Query.SET_POINT, b"REQ\r\n", b"0512\r\n", 512),
    ],
)
def test_lines_in_both_directions(
    request_: Request, line: bytes, reply: bytes, count: int
) -> None:
    assert LINE.encode(request_, 1) == line
    assert LINE.decode_request(line) == request_
    assert LINE.frame_length(request_, reply) == len(reply)
    assert LINE.decode(request_, 1, reply) == count
    assert LINE.decode(request_, 1, LINE.encode_reply(count)) == count


@pytest.mark.parametrize("count", [-1, 1024])
def test_a_set_point_outside_the_range_is_refused_not_clamped(count: int) -> None:
    with pytest.raises(InputError, match=f"{count} is no set-point of an ITV: 0 to 10"):
        Set(count)


@pytest.mark.parametrize(
    ("refusal", "line"),
    [
        (Refusal.UNKNOWN_COMMAND, b"UNKNOWN COMMAND\r\n"),
        (Refusal.OUT_OF_RANGE, b"OUT OF RANGE\r\n"),
    ],
)
def test_a_refusal_says_why(refusal: Refusal, line: bytes) -> None:
    assert LINE.encode_refusal(refusal) == line
    with pytest.raises(DeviceRefused, match=f"'SET 5': {refusal.lower()}") as refused:
        LINE.decode(Set(5), 1, line)
    assert refused.value.exception_code is None


@pytest.mark.parametrize(
    "lie",
    [
        b"1024\r\n",
        b"-1\r\n",
        b"5.0\r\n",
        b" 512\r\n",
        b"00512\r\n",
        b"\r\n",
        b"512",
        b"512\r",
        b"512\r\n\r\n",
        b"OUT OF RANGE",
        b"out of range\r\n",
        b"\xb2\r\n",
        b"",
    ],
)
def test_a_lie_is_not_believed(lie: bytes) -> None:
    with pytest.raises(BadReply, match="'MON' is not believed: it is not a count"):
        LINE.decode(Query.PRESSURE, 1, lie)


def test_a_set_point_must_come_back_as_it_was_sent() -> None:
    with pytest.raises(BadReply, match="another count comes back"):
        LINE.decode(Set(512), 1, b"511\r\n")


def test_a_line_is_complete_with_its_end_and_not_before() -> None:
    reply = b"1023\r\n"
    for cut in range(len(reply)):
        assert LINE.frame_length(Query.PRESSURE, reply[:cut]) is None
    assert LINE.frame_length(Query.PRESSURE, bytearray(reply + b"5")) == len(reply)


def test_a_line_that_does_not_end_cannot_be_followed() -> None:
    assert LINE.frame_length(Query.PRESSURE, b"5" * 31) is None
    with pytest.raises(BadReply, match="does not end"):
        LINE.frame_length(Query.PRESSURE, b"5" * 32)


@pytest.mark.parametrize(
    ("line", "refusal"),
    [
        (b"SET 1024\r\n", Refusal.OUT_OF_RANGE),
        (b"SET x\r\n", Refusal.OUT_OF_RANGE),
        (b"SET\r\n", Refusal.UNKNOWN_COMMAND),
        (b"mon\r\n", Refusal.UNKNOWN_COMMAND),
        (b"\r\n", Refusal.UNKNOWN_COMMAND),
        (b"\xff\r\n", Refusal.UNKNOWN_COMMAND),
    ],
)
def test_a_regulator_refuses_what_it_cannot_do(line: bytes, refusal: Refusal) -> None:
    assert LINE.decode_request(line) is refusal
