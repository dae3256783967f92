"""Following control over a real socket, through gaps, restarts and a failing disk."""

import asyncio
import time
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import msgspec
import pytest

from gripperd.control.command import Command
from gripperd.control.journal import Happening, Journal
from gripperd.control.ledger import Ledger
from gripperd.control.snapshot import Instant
from gripperd.link.client import Client
from gripperd.link.control import ReadCommand
from gripperd.link.frames import decode
from gripperd.link.journal import Page, ReadJournal, page
from gripperd.link.server import serve
from gripperd.service.archive import Archive
from gripperd.service.broadcast import Broadcast
from gripperd.service.command_documents import command_document
from gripperd.service.event_documents import command_record, kept_event
from gripperd.service.follower import Follower
from gripperd.store.history import EventQuery

Eventually = Callable[[Callable[[], bool]], Awaitable[None]]

pytestmark = pytest.mark.anyio


class Control:
    """What control tells, without a gripper behind it."""

    def __init__(self, life: float, length: int = 100) -> None:
        self.life = life
        self.ledger = Ledger("g0", lambda: "c1")
        self.ledger.journal = Journal(length)

    def note(self, text: str) -> None:
        """Have something happen."""
        self.ledger.journal.note(Happening.LEASE, text, 1e9)

    async def respond(self, body: msgspec.Raw) -> Page | Command:
        """Answer as the control process does."""
        request = decode(body, ReadJournal | ReadCommand)  # type: ignore[arg-type]
        if isinstance(request, ReadCommand):
            return self.ledger.get(request.id)
        assert isinstance(request, ReadJournal)
        await asyncio.sleep(0.01)
        after = request.after if request.life == self.life else 0
        return page(self.ledger.journal, self.life, after)


@dataclass
class Following:
    """A follower at work."""

    archive: Archive
    told: list[str]
    client: Client
    folder: Path
    underway: set[str]
    begin: Callable[[], None]

    @asynccontextmanager
    async def answered(self, control: Control) -> AsyncIterator[None]:
        """Follow, while control answers."""
        async with serve(self.folder / "control.sock", control.respond):
            self.begin()
            yield
        await self.client.close()

    def heard(self, text: str) -> bool:
        """Whether something was told."""
        return text in self.told

    async def kept(self) -> list[str]:
        """Texts on the disk, oldest first."""
        query = EventQuery(after=0)
        records = await self.archive.do(lambda history: history.events(query))
        return [kept_event(record).text for record in records]


def soon() -> Instant:
    """A clock that makes ten seconds of a tenth, and was set back a year ago."""
    return Instant(100 * time.monotonic(), 1e9 - 365 * 24 * 3600)


@pytest.fixture
async def following(tmp_path: Path) -> AsyncIterator[Following]:
    """Nobody answers yet, and nobody asks."""
    archive = Archive(tmp_path / "state" / "history.db")
    client = Client(tmp_path / "control.sock", "control")
    broadcast, told, underway = Broadcast(), list[str](), set[str]()
    follower = Follower("g0", client, archive, broadcast, underway, now=soon)

    async def listen() -> None:
        with broadcast.reader() as reader:
            while (event := await reader.next()) is not None:
                told.append(event.text)

    tasks = [asyncio.create_task(listen())]

    def begin() -> None:
        if len(tasks) == 1:
            tasks.append(asyncio.create_task(follower.run()))

    yield Following(archive, told, client, tmp_path, underway, begin)
    for task in tasks:
        task.cancel()
    await asyncio.gather(*tasks, return_exceptions=True)
    await client.close()
    await archive.close()


async def test_what_was_lost_between_is_told(
    following: Following, eventually: Eventually
) -> None:
    control = Control(life=5.0, length=3)
    for number in range(8):
        control.note(f"note {number}")
    async with following.answered(control):
        await eventually(lambda: "note 7" in following.told)
    new_life, lost, *notes = await following.kept()
    assert "new life" in new_life
    assert lost == "5 events were not heard in time"
    assert notes == ["note 5", "note 6", "note 7"]


async def test_a_new_life_begins_to_count_anew(
    following: Following, eventually: Eventually
) -> None:
    for life in (5.0, 3.0):  # the clock was set back between
        control = Control(life)
        control.note(f"life {life}")
        async with following.answered(control):
            await eventually(partial(following.heard, f"life {life}"))
    kept = [text for text in await following.kept() if text.startswith("life")]
    assert kept == ["life 5.0", "life 3.0"]


@pytest.mark.parametrize(
    ("given_to", "code"), [(4.0, "control-restarted"), (5.0, "not-delivered")]
)
async def test_a_command_that_control_does_not_know_is_ended(
    following: Following, eventually: Eventually, given_to: float, code: str
) -> None:
    lost = Ledger("g0", lambda: "c9").accept(None, 5.0, None, Instant(0.0, 1e9))
    record = command_record(command_document(lost), given_to)
    await following.archive.do(lambda history: history.put([record]))
    async with following.answered(Control(5.0)):
        await eventually(lambda: any("c9 failed" in text for text in following.told))
    kept = await following.archive.do(lambda history: history.command("c9"))
    assert kept is not None
    assert kept.final
    assert f'"code":"{code}"' in kept.document


async def test_a_command_that_is_on_its_way_is_left_alone(
    following: Following, eventually: Eventually
) -> None:
    following.underway.add("c9")
    given = Ledger("g0", lambda: "c9").accept(None, 5.0, None, Instant(0.0, 1e9))
    record = command_record(command_document(given), 4.0)
    await following.archive.do(lambda history: history.put([record]))
    control = Control(5.0)
    control.note("something")
    async with following.answered(control):
        await eventually(lambda: "something" in following.told)
    kept = await following.archive.do(lambda history: history.command("c9"))
    assert kept is not None
    assert not kept.final


async def test_without_a_disk_everything_is_told_once_and_kept_later(
    following: Following, eventually: Eventually
) -> None:
    obstacle = following.folder / "state"
    obstacle.write_text("in the way of a folder")
    control = Control(5.0)
    async with following.answered(control):
        for number in range(70):
            control.note(f"note {number}")
        await eventually(lambda: "note 69" in following.told)
        assert following.archive.trouble is not None
        obstacle.unlink()
        await eventually(lambda: following.archive.trouble is None)
        control.note("the last")
        await eventually(lambda: "the last" in following.told)
    notes = [*(f"note {number}" for number in range(70)), "the last"]
    assert [text for text in following.told if text in notes] == notes
    assert [text for text in await following.kept() if text in notes] == notes
