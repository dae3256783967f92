"""Writes down what control tells of one gripper, and ends what it cannot end itself."""

import asyncio
from collections.abc import AsyncIterator, Callable, Iterator, Sequence
from math import inf

import structlog

from gripperd.control.command import Command
from gripperd.control.journal import PAGE
from gripperd.control.loop import clock
from gripperd.control.snapshot import Instant
from gripperd.errors import GripperdError, LinkError, NotFound, Refused
from gripperd.link.client import Client
from gripperd.link.control import ReadCommand
from gripperd.link.journal import Page, ReadJournal
from gripperd.service.archive import Archive
from gripperd.service.broadcast import Broadcast
from gripperd.service.command_documents import CommandDocument, command_document
from gripperd.service.endings import NEVER_BEGUN, RESTARTED, ended
from gripperd.service.event_documents import (
    EventDocument,
    EventKind,
    command_record,
    event_of,
    event_record,
    kept_event,
)
from gripperd.service.rendering import timestamp
from gripperd.store.history import (
    NOT_RECORDED,
    CommandRecord,
    EventRecord,
    History,
)

LOOK = 5.0
"""Longest time between two looks for commands that need an end. [s]"""
GRACE = 5.0
"""How much later than it was asked for a page may come. [s]"""
PAUSE = 0.5
"""Before control, or the disk, is tried again. [s]"""
UNDERWAY = 10.0
"""A command that control may still begin is not older: see `Submissions`. [s]"""

log = structlog.get_logger()


class Follower:
    """Follows the journal of one gripper; control never waits for it.

    Parameters
    ----------
    gripper
        Its name.
    control
        Answers :mod:`gripperd.link.control`.
    archive
        Where everything is kept.
    broadcast
        Who else is told.
    underway
        Ids of commands that somebody is about to give to control.
    now
        The time, on both clocks.
    """

    def __init__(
        self,
        gripper: str,
        control: Client,
        archive: Archive,
        broadcast: Broadcast,
        underway: set[str],
        now: Callable[[], Instant] = clock,
    ) -> None:
        self.life = 0.0
        """Of the control process that was heard last."""
        self._gripper = gripper
        self._control = control
        self._archive = archive
        self._broadcast = broadcast
        self._underway = underway
        self._now = now
        self._entry: int | None = None
        self._told = (0.0, -1)
        self._looked = -inf
        self._seen: dict[str, float] = {}
        """Commands without an end, and when each was seen first. [s]"""

    async def run(self) -> None:
        """Follow for ever; what cannot be kept now is asked for again."""
        while True:
            try:
                await self._follow()
            except LinkError:
                await asyncio.sleep(PAUSE)
            except GripperdError as error:
                log.error("not followed", gripper=self._gripper, cause=str(error))
                await asyncio.sleep(LOOK)

    async def _follow(self) -> None:
        try:
            if self._entry is None:
                life, entry = await self._archive.do(self._last)
                self.life, self._entry = life, entry
            await self._keep(await self._page(self.life, self._entry, LOOK))
        except Refused as refused:
            if refused.code != NOT_RECORDED:
                raise
            life, entry = self._told
            self._tell_unkept(await self._page(life, max(entry, 0), PAUSE))

    def _last(self, history: History) -> tuple[float, int]:
        return history.last_entry(self._gripper)

    async def _page(self, life: float, entry: int, wait: float) -> Page:
        request = ReadJournal(self._gripper, life, entry, wait)
        return await self._control.ask(request, Page, wait + GRACE)

    async def _keep(self, page: Page) -> None:
        events = [*self._preface(page), *self._records(page)]
        commands = [
            command_record(command_document(entry.command), page.life)
            for entry in page.entries
            if entry.command is not None
        ]
        told = {command.id for command in commands}
        async for command in self._ends(page):
            if command.id not in told:
                commands.append(command_record(command, page.life))
                events.append(event_record(_ended(command)))
        kept = await self._archive.do(lambda history: history.put(commands, events))
        self._tell(page, kept)

    def _preface(self, page: Page) -> Iterator[EventRecord]:
        """What was missed, told under the number before the first that was not."""
        known = self._entry or 0
        if page.life != self.life:
            known = 0
            text = "the control process began a new life; it adopts what it finds"
            yield self._about_control(text, page, 0)
        if (lost := page.oldest - 1 - known) > 0:
            text = f"{lost} events were not heard in time"
            yield self._about_control(text, page, page.oldest - 1)

    def _about_control(self, text: str, page: Page, entry: int) -> EventRecord:
        event = EventDocument(
            at=timestamp(self._now().wall),
            kind=EventKind.CONTROL,
            gripper=self._gripper,
            text=text,
        )
        return event_record(event, page.life, entry)

    def _records(self, page: Page) -> Iterator[EventRecord]:
        for entry in page.entries:
            event = event_of(entry, self._gripper)
            yield event_record(event, page.life, entry.number)

    async def _ends(self, page: Page) -> AsyncIterator[CommandDocument]:
        """Commands without an end that control does not know: what became of them."""
        now = self._now().monotonic
        due = page.life != self.life or now - self._looked > LOOK
        # While there is more to read, that may tell.
        if not due or len(page.entries) == PAGE:
            return
        unfinished = await self._archive.do(self._unfinished)
        self._seen = {each.id: self._seen.get(each.id, now) for each in unfinished}
        for record in unfinished:
            if record.id not in self._underway:
                found = await self._found(record, page.life)
                if found is not None:
                    yield found
        self._looked = now

    def _unfinished(self, history: History) -> Sequence[CommandRecord]:
        return history.unfinished(self._gripper)

    async def _found(
        self, record: CommandRecord, life: float
    ) -> CommandDocument | None:
        """One command with an end that nobody else tells, if there is one."""
        request = ReadCommand(self._gripper, record.id)
        now = self._now()
        # By the clock that never steps: one that is set back would keep it waiting.
        late = now.monotonic - self._seen[record.id] > UNDERWAY
        try:
            command = await self._control.ask(request, Command)
        except NotFound:
            # Nobody had heard of control yet when a command was given to life 0.
            if record.life not in {0.0, life}:
                return ended(record, RESTARTED, now.wall)
            return ended(record, NEVER_BEGUN, now.wall) if late else None
        # Its journal tells, unless too much was missed.
        return command_document(command) if command.final and late else None

    def _tell(self, page: Page, kept: Sequence[EventRecord]) -> None:
        for record in kept:
            if record.entry is None or self._is_news(page.life, record.entry):
                self._broadcast.tell(kept_event(record))
        if page.life != self.life:
            self.life, self._entry = page.life, 0
        if page.entries:
            self._entry = page.entries[-1].number
        if self._is_news(self.life, self._entry or 0):
            self._told = (self.life, self._entry or 0)

    def _tell_unkept(self, page: Page) -> None:
        """Let readers know at once; on disk it will be when the disk works again."""
        for entry in page.entries:
            if self._is_news(page.life, entry.number):
                self._broadcast.tell(event_of(entry, self._gripper))
                self._told = (page.life, entry.number)

    def _is_news(self, life: float, entry: int) -> bool:
        return life != self._told[0] or entry > self._told[1]


def _ended(command: CommandDocument) -> EventDocument:
    assert command.completed_at is not None
    reason = "" if command.error is None else f": {command.error.message}"
    return EventDocument(
        at=command.completed_at,
        kind=EventKind.COMMAND,
        gripper=command.gripper,
        text=f"{command.type} {command.id[:8]} {command.status}{reason}",
        command=command,
    )
