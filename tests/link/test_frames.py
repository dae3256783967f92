import asyncio
from contextlib import suppress

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gripperd import errors
from gripperd.link.frames import (
    LONGEST,
    Answer,
    Ask,
    decode,
    encode,
    failed,
    frame,
    raised,
    read_frame,
)


def stream(octets: bytes) -> asyncio.StreamReader:
    reader = asyncio.StreamReader()
    reader.feed_data(octets)
    reader.feed_eof()
    return reader


async def test_a_frame_is_a_length_and_a_body() -> None:
    octets = frame(Ask(7, msgspec.Raw(encode("hello"))))
    assert octets == bytes.fromhex("00 00 00 08 92 07 a5 68 65 6c 6c 6f")
    body = await read_frame(stream(octets))
    assert body is not None
    ask = decode(body, Ask)
    assert (ask.id, decode(ask.body, str)) == (7, "hello")


@pytest.mark.parametrize("length", range(12))
async def test_a_frame_that_breaks_off_is_the_end(length: int) -> None:
    octets = frame(Ask(7, msgspec.Raw(encode("hello"))))
    assert await read_frame(stream(octets[:length])) is None


async def test_a_frame_of_a_gigabyte_is_not_waited_for() -> None:
    with pytest.raises(errors.BadReply, match="1073741824 octets is not ours"):
        await read_frame(stream(bytes.fromhex("40 00 00 00")))


async def test_the_longest_frame_is_read() -> None:
    body = bytes(LONGEST)
    assert await read_frame(stream(LONGEST.to_bytes(4) + body)) == body


@given(st.binary(max_size=60))
def test_no_body_breaks_the_decoder(body: bytes) -> None:
    for kind in (Ask, Answer):
        with suppress(errors.BadReply):
            assert isinstance(decode(body, kind), kind)


@pytest.mark.parametrize(
    "error",
    [
        errors.InputError("no", key="current_mA"),
        errors.DomainError("no", key="diameter_mm"),
        errors.NotFound("no", key="id"),
        errors.Refused("no", code="wrong-state", hints=("wait", "stop")),
        errors.LinkLost("no"),
        errors.ReplyTimeout("no"),
        errors.BadReply("no"),
        errors.LinkError("no"),
        errors.GripperdError("no"),
    ],
    ids=lambda error: type(error).__name__,
)
def test_an_error_travels_as_itself(error: errors.GripperdError) -> None:
    answer = Answer(1, msgspec.Raw(encode(None)), failed(error))
    travelled = decode(frame(answer)[4:], Answer).failed
    assert travelled is not None
    arrived = raised(travelled)
    assert type(arrived) is type(error)
    assert str(arrived) == str(error)
    assert vars(arrived) == vars(error)


def test_the_refusal_of_a_device_travels_with_its_code() -> None:
    arrived = raised(failed(errors.DeviceRefused("no", exception_code=4)))
    assert isinstance(arrived, errors.DeviceRefused)
    assert arrived.exception_code == 4
