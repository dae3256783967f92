import asyncio
import socket
import stat
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from pathlib import Path

import msgspec
import pytest

from gripperd import errors
from gripperd.link.client import Client
from gripperd.link.frames import Ask, decode, encode, frame
from gripperd.link.server import serve

SOON = 60.0
"""Longest wait for something that must happen; no test takes this long. [s]"""


class Say(msgspec.Struct, frozen=True, tag=True):
    """What the tests ask."""

    text: str


async def shout(body: msgspec.Raw) -> object:
    return decode(body, Say).text.upper()


def failing(error: Exception) -> Callable[[msgspec.Raw], Awaitable[object]]:
    async def respond(body: msgspec.Raw) -> object:
        raise error

    return respond


@asynccontextmanager
async def asking(path: Path) -> AsyncIterator[Client]:
    client = Client(path, "the peer")
    try:
        yield client
    finally:
        await client.close()


def permissions(path: Path) -> int:
    return stat.S_IMODE(path.stat().st_mode)


def exists(path: Path) -> bool:
    return path.exists()


async def test_a_question_is_answered(socket_path: Path) -> None:
    async with serve(socket_path, shout), asking(socket_path) as client:
        assert await client.ask(Say("egg"), str) == "EGG"


async def test_only_the_user_may_open_the_socket(socket_path: Path) -> None:
    async with serve(socket_path, shout):
        assert permissions(socket_path) == 0o600
        assert permissions(socket_path.parent) == 0o700


async def test_the_socket_is_gone_afterwards(socket_path: Path) -> None:
    async with serve(socket_path, shout):
        pass
    assert not exists(socket_path)


@pytest.fixture
def left_over(socket_path: Path) -> Path:
    """A socket that nobody listens on any more."""
    socket_path.parent.mkdir()
    with socket.socket(socket.AF_UNIX) as dead:
        dead.bind(str(socket_path))
    return socket_path


async def test_a_socket_of_an_earlier_life_is_replaced(left_over: Path) -> None:
    async with serve(left_over, shout), asking(left_over) as client:
        assert await client.ask(Say("egg"), str) == "EGG"


@pytest.mark.parametrize(
    "error",
    [
        errors.Refused("held", code="object-held", hints=("release first",)),
        errors.InputError("bad", key="force_N"),
        errors.NotFound("none", key="id"),
        errors.LinkLost("gone"),
    ],
    ids=lambda error: type(error).__name__,
)
async def test_an_error_is_raised_again_at_the_other_end(
    socket_path: Path, error: errors.GripperdError
) -> None:
    async with serve(socket_path, failing(error)), asking(socket_path) as client:
        with pytest.raises(type(error)) as caught:
            await client.ask(Say("egg"), str)
        assert type(caught.value) is type(error)
        assert vars(caught.value) == vars(error)


async def test_many_questions_are_answered_each_to_its_own(socket_path: Path) -> None:
    async def echo_later(body: msgspec.Raw) -> object:
        text = decode(body, Say).text
        # The later asked, the earlier answered.
        await asyncio.sleep(0.05 - int(text) / 2000)
        return text

    async with serve(socket_path, echo_later), asking(socket_path) as client:
        texts = [str(number) for number in range(100)]
        answers = await asyncio.gather(*(client.ask(Say(t), str) for t in texts))
        assert answers == texts


async def test_a_long_wait_does_not_hold_up_the_others(socket_path: Path) -> None:
    arrived, let_go = asyncio.Event(), asyncio.Event()

    async def patient(body: msgspec.Raw) -> object:
        text = decode(body, Say).text
        if text == "wait":
            arrived.set()
            await let_go.wait()
        return text

    async with serve(socket_path, patient), asking(socket_path) as client:
        waiting = asyncio.create_task(client.ask(Say("wait"), str, SOON))
        async with asyncio.timeout(SOON):
            await arrived.wait()
        assert await client.ask(Say("stop"), str, SOON) == "stop"
        assert not waiting.done()
        let_go.set()
        assert await waiting == "wait"


@pytest.mark.parametrize(
    "garbage",
    [
        pytest.param(b"\x00\x00\x00\x04\xc1\xc1\xc1\xc1", id="no MessagePack"),
        pytest.param(b"\x00\x00\x00\x01\x01", id="no question"),
        pytest.param(b"\x00\x00\x00\x10abc", id="half a frame"),
        pytest.param(b"\xff\xff\xff\xff", id="4 GB"),
        pytest.param(b"GET / HTTP/1.1\r\n\r\n", id="HTTP"),
    ],
)
async def test_garbage_ends_one_conversation_quietly(
    socket_path: Path, garbage: bytes
) -> None:
    async with serve(socket_path, shout), asking(socket_path) as client:
        assert await client.ask(Say("egg"), str) == "EGG"
        reader, writer = await asyncio.open_unix_connection(socket_path)
        writer.write(garbage)
        if garbage.endswith(b"abc"):
            writer.write_eof()
        async with asyncio.timeout(SOON):
            assert await reader.read() == b""
        writer.close()
        assert await client.ask(Say("apple"), str) == "APPLE"


async def test_a_question_of_the_wrong_kind_is_told(socket_path: Path) -> None:
    class Sing(msgspec.Struct, frozen=True, tag=True):
        text: str

    async with serve(socket_path, shout), asking(socket_path) as client:
        with pytest.raises(errors.BadReply, match="garbled"):
            await client.ask(Sing("egg"), str)
        assert await client.ask(Say("egg"), str) == "EGG"


async def test_a_client_that_leaves_in_the_middle_harms_nobody(
    socket_path: Path,
) -> None:
    arrived, let_go = asyncio.Event(), asyncio.Event()

    async def patient(body: msgspec.Raw) -> object:
        if decode(body, Say).text == "wait":
            arrived.set()
            await let_go.wait()
        return "done"

    async with serve(socket_path, patient), asking(socket_path) as client:
        _, writer = await asyncio.open_unix_connection(socket_path)
        writer.write(frame(Ask(1, msgspec.Raw(encode(Say("wait"))))))
        async with asyncio.timeout(SOON):
            await arrived.wait()
        writer.close()
        let_go.set()
        assert await client.ask(Say("egg"), str) == "done"


async def test_a_second_server_does_not_take_the_socket_of_the_first(
    socket_path: Path,
) -> None:
    async with serve(socket_path, shout), asking(socket_path) as client:
        with pytest.raises(errors.Refused, match="another process answers"):
            async with serve(socket_path, failing(errors.LinkError("second"))):
                pass
        assert await client.ask(Say("egg"), str) == "EGG"


async def test_the_socket_of_a_dead_server_is_taken_over(socket_path: Path) -> None:
    socket_path.parent.mkdir()
    with socket.socket(socket.AF_UNIX) as dead:
        dead.bind(str(socket_path))
    async with serve(socket_path, shout), asking(socket_path) as client:
        assert await client.ask(Say("egg"), str) == "EGG"


async def test_a_defect_ends_one_request_and_no_other(socket_path: Path) -> None:
    let_go = asyncio.Event()

    async def clumsy(body: msgspec.Raw) -> object:
        if decode(body, Say).text == "wait":
            await let_go.wait()
            return "done"
        raise ZeroDivisionError

    async with serve(socket_path, clumsy), asking(socket_path) as client:
        waiting = asyncio.create_task(client.ask(Say("wait"), str, SOON))
        with pytest.raises(errors.GripperdError, match="ZeroDivision") as caught:
            await client.ask(Say("divide"), str, SOON)
        # A lost link would be worth another try; a defect is not.
        assert not isinstance(caught.value, errors.LinkError)
        let_go.set()
        assert await waiting == "done"


@pytest.fixture
def precious(socket_path: Path) -> Path:
    """A file of the user's, named as the socket by mistake."""
    socket_path.parent.mkdir()
    socket_path.write_text("precious")
    return socket_path


async def test_a_file_that_is_no_socket_is_not_deleted(precious: Path) -> None:
    with pytest.raises(errors.ConfigError, match="is in the way"):
        async with serve(precious, shout):
            pass
    assert exists(precious)


async def test_a_folder_that_is_a_link_is_not_served_from(socket_path: Path) -> None:
    elsewhere = socket_path.parent.with_name("elsewhere")
    elsewhere.mkdir()
    socket_path.parent.symlink_to(elsewhere)
    with pytest.raises(errors.ConfigError, match="is not a directory"):
        async with serve(socket_path, shout):
            pass
