"""The clock of control: read, decide, write, at a fixed rate."""

import asyncio
import time
from collections.abc import Callable
from contextlib import suppress
from typing import TYPE_CHECKING

import structlog

from gripperd.control.alarm import Alarm
from gripperd.control.command import Command, Order, Status
from gripperd.control.gripper import Gripper
from gripperd.control.journal import Happening, Journal
from gripperd.control.ledger import LONGEST_QUEUE, Key
from gripperd.control.pace import Pace
from gripperd.control.snapshot import GripperState, Instant
from gripperd.control.timing import Timing
from gripperd.drivers.analog import AnalogRig
from gripperd.drivers.facts import RigFacts
from gripperd.errors import InputError, LinkError

if TYPE_CHECKING:
    from gripperd.control.states import Grip, Machine


def clock() -> Instant:
    """The time, on both clocks."""
    return Instant(time.monotonic(), time.time())


class Loop:
    """Runs one gripper on one rig, and passes on what clients ask.

    Parameters
    ----------
    gripper
        What decides.
    rig
        What measures and acts.
    period
        Time between two samples. [s]
    now
        The clock.
    advanced
        Called after every period, with or without an answer from the rig.
    """

    def __init__(
        self,
        gripper: Gripper,
        rig: AnalogRig,
        *,
        period: float,
        now: Callable[[], Instant] = clock,
        advanced: Callable[[], None] = lambda: None,
    ) -> None:
        self.gripper = gripper
        self._rig = rig
        self._now = now
        self._pace = Pace(period, lambda: now().monotonic)
        self._advanced = advanced
        self._news = asyncio.Event()
        self._log = structlog.get_logger().bind(gripper=gripper.name)
        self._told: tuple[Machine, Grip] | None = None
        self._statuses: dict[str, Status] = {}
        self._read = 0

    @property
    def facts(self) -> RigFacts:
        """What is known of the modules by now."""
        return self._rig.facts

    async def run(self) -> None:
        """Control for ever; each period ends at an absolute deadline."""
        last = self._now().monotonic
        self._pace.begin()
        with Alarm() as alarm:
            while True:
                last = await self._step(last)
                self._tell()
                self._news.set()
                self._news = asyncio.Event()
                self._advanced()
                await self._pace.next(alarm.until)

    def timing(self) -> Timing:
        """How punctual it has been."""
        return self._pace.timing()

    async def _step(self, last: float) -> float:
        """One period; the time of its decision, which the next counts from."""
        now = self._now()
        try:
            measured = await self._rig.read(now.monotonic)
            now = self._now()
            change = self.gripper.period(measured, now.monotonic - last, now)
            if change is not None:
                await self._rig.write(change)
        except (LinkError, InputError) as error:
            # A current that the module cannot give is as good as no link.
            self.gripper.link_lost(str(error), self._now())
        return now.monotonic

    def _tell(self) -> None:
        """Log what has changed: faults, states, commands that began or ended."""
        gripper = self.gripper
        now = self._now()
        seen = gripper.state(now)
        gripper.ledger.journal.look(seen, now.wall)
        self._tell_faults(gripper.ledger.journal)
        state = (seen.machine, seen.grip)
        if state != self._told:
            self._told = state
            self._log.info(
                "state",
                machine=seen.machine,
                grip=seen.grip,
                adopted=seen.adopted,
                link=seen.link,
            )
        newest = gripper.ledger.newest(LONGEST_QUEUE + 1)
        for command in reversed(newest):
            if self._statuses.get(command.id) is not command.status:
                self._log.info("command", **_summary(command))
        self._statuses = {command.id: command.status for command in newest}

    def _tell_faults(self, journal: Journal) -> None:
        if journal.newest == self._read:
            return
        for entry in journal.since(self._read):
            self._read = entry.number
            if entry.kind is Happening.FAULT:
                self._log.warning("fault", what=entry.text)

    def state(self) -> GripperState:
        """Snapshot of the gripper."""
        return self.gripper.state(self._now())

    def submit(
        self, order: Order, deadline: float, key: Key | None
    ) -> tuple[Command, bool]:
        """Accept a command, see :meth:`Gripper.submit`."""
        return self.gripper.submit(order, deadline, key, self._now())

    def enable(self) -> None:
        """Allow commands."""
        self.gripper.enable()

    def disable(self) -> None:
        """Allow no more commands."""
        self.gripper.disable(self._now())

    async def stop(self) -> GripperState:
        """Freeze now: the write passes everything that waits for the bus."""
        await self._write_at_once(self.gripper.stop(self._now()))
        return self.state()

    async def cancel(self, command: str) -> Command:
        """End one command."""
        await self._write_at_once(self.gripper.cancel(command, self._now()))
        return self.gripper.ledger.get(command)

    def present(self) -> Instant:
        """The time, on both clocks."""
        return self._now()

    async def follow(self, number: int, seconds: float) -> Journal:
        """The journal once it has an entry after a number, or the time is up."""
        until = self._now().monotonic + seconds
        journal = self.gripper.ledger.journal
        while journal.newest <= number:
            left = until - self._now().monotonic
            if left <= 0:
                break
            with suppress(TimeoutError):
                async with asyncio.timeout(left):
                    await self._news.wait()
        return journal

    async def wait(self, command: str, seconds: float) -> Command:
        """One command once it is over, or as it stands when the time is up."""
        until = self._now().monotonic + seconds
        while not (found := self.gripper.ledger.get(command)).final:
            left = until - self._now().monotonic
            if left <= 0:
                break
            try:
                async with asyncio.timeout(left):
                    await self._news.wait()
            except TimeoutError:
                continue
        return found

    async def _write_at_once(self, change: float | None) -> None:
        if change is None:
            return
        try:
            await self._rig.write(change, urgent=True)
        except LinkError as error:
            self.gripper.link_lost(str(error), self._now())
            raise


def _summary(command: Command) -> dict[str, object]:
    facts: dict[str, object] = {
        "id": command.id[:8],
        "type": command.kind,
        "status": command.status,
    }
    if command.order is not None:
        facts["profile"] = command.order.profile.name
    if command.result is not None and command.result.force is not None:
        facts["force_N"] = round(command.result.force, 2)
    if command.error is not None:
        facts["reason"] = command.error.message
    return facts
