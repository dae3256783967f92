import asyncio
from collections.abc import AsyncIterator, Awaitable, Callable
from pathlib import Path

import pytest
from starlette.types import Message

from gripperd.service.archive import Archive
from gripperd.service.broadcast import LONGEST, Broadcast
from gripperd.service.event_documents import EventDocument, EventKind, event_record
from gripperd.service.event_stream import EventStream
from gripperd.service.rendering import timestamp

Eventually = Callable[[Callable[[], bool]], Awaitable[None]]

pytestmark = pytest.mark.anyio


def event(number: int | None) -> EventDocument:
    return EventDocument(
        number=number, at=timestamp(1e9), kind=EventKind.LEASE, text=f"event {number}"
    )


@pytest.fixture
async def archive(tmp_path: Path) -> AsyncIterator[Archive]:
    """Three events are kept."""
    archive = Archive(tmp_path / "history.db", now=lambda: 1e9)
    told = [event_record(event(None)) for _ in range(3)]
    await archive.do(lambda history: history.put(told=told))
    yield archive
    await archive.close()


class Line:
    """The connection of one reader."""

    def __init__(self) -> None:
        self.sent = list[bytes]()
        self.over = False
        self.flows = asyncio.Event()
        self.flows.set()

    async def send(self, message: Message) -> None:
        """Take what is sent, while it flows."""
        await self.flows.wait()
        if message["type"] == "http.response.body":
            self.sent.append(message["body"])
            self.over = not message["more_body"]

    async def receive(self) -> Message:
        """Never leave."""
        await asyncio.Event().wait()
        return {"type": "http.disconnect"}

    @property
    def ids(self) -> list[str]:
        """Ids of the events that came."""
        lines = b"".join(self.sent).decode().splitlines()
        return [line.removeprefix("id: ") for line in lines if line.startswith("id: ")]


async def test_the_past_comes_first_and_nothing_twice(
    archive: Archive, eventually: Eventually
) -> None:
    broadcast, line = Broadcast(), Line()
    stream = EventStream(archive, broadcast, 1)
    task = asyncio.create_task(stream({}, line.receive, line.send))
    await eventually(lambda: line.ids == ["2", "3"])
    for number in (3, 4):
        broadcast.tell(event(number))
    await eventually(lambda: line.ids == ["2", "3", "4"])
    broadcast.end()
    await task
    assert line.over


async def test_a_reader_that_does_not_read_is_dropped_and_nobody_waits_for_it(
    archive: Archive, eventually: Eventually
) -> None:
    broadcast, line = Broadcast(), Line()
    stream = EventStream(archive, broadcast, None, slowest=0.05)
    task = asyncio.create_task(stream({}, line.receive, line.send))
    await eventually(lambda: bool(line.sent))
    line.flows.clear()
    for number in range(10):
        broadcast.tell(event(number))
    async with asyncio.timeout(60):
        await task
    assert not line.over


async def test_a_reader_too_far_behind_gets_no_more() -> None:
    broadcast = Broadcast()
    with broadcast.reader() as slow, broadcast.reader() as quick:
        for number in range(LONGEST + 1):
            broadcast.tell(event(number))
            found = await quick.next()
            assert found is not None
            assert found.number == number
        assert await slow.next() is None


async def test_silence_is_broken_by_a_comment(
    archive: Archive, eventually: Eventually
) -> None:
    line = Line()
    stream = EventStream(archive, Broadcast(), None, quiet=0.01)
    task = asyncio.create_task(stream({}, line.receive, line.send))
    await eventually(lambda: len(line.sent) > 2)
    task.cancel()
    assert set(line.sent) == {b": ping\n\n"}
