import asyncio
import time
from collections.abc import Awaitable, Callable
from pathlib import Path

import msgspec
import pytest

from gripperd.errors import BadReply, LinkError, LinkLost, ReplyTimeout
from gripperd.link.client import Client
from gripperd.link.frames import decode
from gripperd.link.server import serve

Eventually = Callable[[Callable[[], bool]], Awaitable[None]]
SOON = 60.0
"""Longest wait for something that must happen; no test takes this long. [s]"""


class Say(msgspec.Struct, frozen=True, tag=True):
    """What the tests ask."""

    text: str


async def echo(body: msgspec.Raw) -> object:
    return decode(body, Say).text


async def ponder(body: msgspec.Raw) -> object:
    await asyncio.Event().wait()
    return None


async def test_nobody_there_is_a_lost_link(socket_path: Path) -> None:
    client = Client(socket_path, "the control process")
    with pytest.raises(LinkLost, match="the control process is not running"):
        await client.ask(Say("egg"), str)


async def test_it_asks_again_after_the_other_end_was_restarted(
    socket_path: Path,
) -> None:
    client = Client(socket_path, "the control process")
    for life in ("1", "2", "3"):
        async with serve(socket_path, echo):
            assert await client.ask(Say(life), str) == life
        await quiet(client)
        with pytest.raises(LinkLost):
            await client.ask(Say("nobody"), str)
    await client.close()


async def quiet(client: Client) -> None:
    """Return once the client has seen the end of its connection."""
    assert client._reading is not None
    async with asyncio.timeout(SOON):
        await asyncio.wait([client._reading])


async def test_a_restart_in_the_middle_of_a_question_is_a_lost_link(
    socket_path: Path, eventually: Eventually
) -> None:
    client = Client(socket_path, "the control process")
    async with serve(socket_path, ponder):
        asking = asyncio.create_task(client.ask(Say("egg"), str, SOON))
        await eventually(lambda: bool(client._waiting))
        await asyncio.sleep(0.01)
    with pytest.raises(LinkLost, match="the control process went away"):
        await asking
    await client.close()


async def test_no_answer_in_time_is_told_and_the_line_stays(socket_path: Path) -> None:
    late = asyncio.Event()

    async def slow(body: msgspec.Raw) -> object:
        text = decode(body, Say).text
        if text == "slow":
            await late.wait()
        return text

    client = Client(socket_path, "the control process")
    async with serve(socket_path, slow):
        with pytest.raises(ReplyTimeout, match=r"within 0\.05 s"):
            await client.ask(Say("slow"), str, 0.05)
        late.set()
        # The late answer to the first question is not that to the second.
        assert await client.ask(Say("egg"), str) == "egg"
        assert client._waiting == {}
    await client.close()


async def test_a_stall_of_this_process_is_no_silence_of_the_other(
    socket_path: Path,
) -> None:
    async def stall(body: msgspec.Raw) -> object:
        # Client and server share the loop: neither sees anything for so long.
        time.sleep(1.2)  # noqa: ASYNC251
        return decode(body, Say).text

    client = Client(socket_path, "the control process")
    async with serve(socket_path, stall):
        assert await client.ask(Say("egg"), str, 1.0) == "egg"
    await client.close()


async def test_an_answer_of_another_kind_is_not_believed(socket_path: Path) -> None:
    client = Client(socket_path, "the control process")
    async with serve(socket_path, echo):
        with pytest.raises(BadReply, match="garbled"):
            await client.ask(Say("egg"), int)
        assert await client.ask(Say("egg"), str) == "egg"
    await client.close()


async def test_garbage_from_the_other_end_is_a_lost_link(tmp_path: Path) -> None:
    socket_path = tmp_path / "s"

    async def babble(
        reader: asyncio.StreamReader, writer: asyncio.StreamWriter
    ) -> None:
        await reader.read(1)
        writer.write(b"\x00\x00\x00\x04\xc1\xc1\xc1\xc1")
        await reader.read()
        writer.close()

    server = await asyncio.start_unix_server(babble, socket_path)
    client = Client(socket_path, "the control process")
    with pytest.raises(LinkError):
        await client.ask(Say("egg"), str, SOON)
    await client.close()
    server.close()


async def test_a_cancelled_question_leaves_the_others_alone(
    socket_path: Path, eventually: Eventually
) -> None:
    client = Client(socket_path, "the control process")
    let_go = asyncio.Event()

    async def patient(body: msgspec.Raw) -> object:
        await let_go.wait()
        return decode(body, Say).text

    async with serve(socket_path, patient):
        first, second = (
            asyncio.create_task(client.ask(Say(text), str, SOON))
            for text in ("first", "second")
        )
        await eventually(lambda: len(client._waiting) == 2)
        first.cancel()
        let_go.set()
        assert await second == "second"
    await client.close()


async def test_closing_ends_the_questions_that_wait(
    socket_path: Path, eventually: Eventually
) -> None:
    client = Client(socket_path, "the control process")
    async with serve(socket_path, ponder):
        asking = asyncio.create_task(client.ask(Say("egg"), str, 0.2))
        await eventually(lambda: bool(client._waiting))
        await client.close()
        with pytest.raises(LinkLost):
            await asking
