"""The commands of one gripper, from the queue through their execution to their end."""

from dataclasses import replace

from gripperd.control.admission import Scene, admit
from gripperd.control.command import (
    CANCELLED,
    OBJECT_HELD,
    Command,
    Failure,
    Status,
    no_answer,
    not_possible,
)
from gripperd.control.ending import Ending
from gripperd.control.execution import Execution
from gripperd.control.hold import Hold
from gripperd.control.keep import Keep
from gripperd.control.ledger import Ledger
from gripperd.control.lifecycle import Lifecycle
from gripperd.control.output import Output
from gripperd.control.snapshot import Instant
from gripperd.control.states import Event, Grip, Machine
from gripperd.control.task import Tared, Task
from gripperd.control.zero import UNTARED, Zero
from gripperd.errors import GripperdError, Refused
from gripperd.model import Chain
from gripperd.signals import Measurement

STOP_TIME = 0.3
"""Regulator and muscle are at rest after this. [s]"""


class Dispatch:
    """Runs one command at a time, and closes every one that it takes.

    Parameters
    ----------
    life, ledger, output, hold
        Of the gripper.
    """

    def __init__(
        self, life: Lifecycle, ledger: Ledger, output: Output, hold: Hold
    ) -> None:
        self._life = life
        self._ledger = ledger
        self._output = output
        self._hold = hold
        self._execution: Execution | None = None
        self._measured: Measurement | None = None
        self._dwell = 0.0
        self.keep = Keep()
        """What is held, and what is done about it between commands."""
        self.zero = UNTARED
        """Of the force sensor."""

    @property
    def running(self) -> str | None:
        """The command that runs."""
        return None if self._execution is None else self._execution.command.id

    def scene(self, chain: Chain, measured: Measurement) -> Scene:
        """What a command would find now."""
        vented = self._output.current <= chain.regulator.current_low
        return Scene(
            chain=chain,
            current=self._output.current,
            measured=measured,
            grip=self._hold.grip,
            held=self.keep.held,
            objection=self._hold.objection(vented=vented),
            zero=self.zero.force,
        )

    def check(self, task: Task, chain: Chain, measured: Measurement | None) -> None:
        """Refuse a task at once, unless something else will have happened by then."""
        waits = self.running is not None or any(self._ledger.waiting())
        if not waits and measured is not None:
            admit(task, self.scene(chain, measured))

    def start_next(self, chain: Chain, measured: Measurement, now: Instant) -> None:
        """Begin what waits, unless it could let go of something."""
        if (command := self._ledger.next()) is None:
            return
        scene = self.scene(chain, measured)
        if command.order is not None and scene.objection:
            self._ledger.close(command, now.wall, failure=OBJECT_HELD)
            return
        try:
            if command.task is not None:
                admit(command.task, scene)
            self._execution = Execution(command, scene, now.wall)
        except Refused as refused:
            self._ledger.close(command, now.wall, failure=not_possible(refused))
            return
        except GripperdError as error:
            self._ledger.close(command, now.wall, failure=no_answer(error))
            return
        self._life.on(Event.START)
        self._ledger.put(self._execution.command)
        held = self.keep.held if command.task is not None else None
        name = None if held is None else held.profile.name
        self._hold.settle(self._execution.grip, name)

    def step(self, measured: Measurement, dt: float, now: Instant) -> None:
        """Advance what runs by one period."""
        self._measured = measured
        self._come_to_rest(dt)
        self._yield_to_others(measured, now)
        self._execute(measured, dt, now)
        self._expire(now)

    def resume(self, *, same: bool) -> None:
        """Take over what is found; it is what it was if nothing has moved since."""
        held = self.keep.held if same else None
        self._hold.adopt(None if held is None else held.profile.name)
        self.keep.begin(held)

    def look_after(self, measured: Measurement, chain: Chain, dt: float) -> None:
        """See to what is held between commands."""
        keep, output = self.keep, self._output
        if self._hold.grip is not Grip.HOLDING:
            keep.begin(None)
        elif output.adopted:
            keep.leave()
        elif self._life.state is Machine.READY:
            output.current = keep.step(measured, chain, output.current, dt)
        else:
            keep.pause()

    def cancel(self, command: Command, now: Instant) -> None:
        """End one command; freeze if it is the one that runs.

        Raises
        ------
        Refused
            It is over already.
        """
        if command.final:
            message = f"command {command.id} is over: {command.status}"
            raise Refused(message, code="already-final")
        if command.id == self.running:
            self.interrupt(CANCELLED, now)
        else:
            self._ledger.close(command, now.wall, failure=CANCELLED)

    def interrupt(self, failure: Failure, now: Instant) -> None:
        """Freeze, and end what runs."""
        self.freeze()
        self._cut_short(failure, now)

    def freeze(self) -> None:
        """Let the jaws rest where they are: the pressure lags behind the current."""
        self._life.on(Event.STOP)
        self._dwell = 0.0
        self.rest()

    def rest(self) -> None:
        """Take the current back to where the jaws are by now."""
        if self._execution is not None and self._measured is not None:
            self._execution.motion.rest(self._measured)
            self._output.current = self._execution.motion.ramp.current

    def end_all(self, failure: Failure, now: Instant) -> None:
        """End what runs and what waits."""
        if self._execution is not None:
            self._cut_short(failure, now)
        for command in self._ledger.waiting():
            self._ledger.close(command, now.wall, failure=failure)

    def _come_to_rest(self, dt: float) -> None:
        if self._life.state is Machine.STOPPING:
            self._dwell += dt
            if self._dwell > STOP_TIME:
                self._life.on(Event.REST)

    def _yield_to_others(self, measured: Measurement, now: Instant) -> None:
        """Adopt a current that something else has set; never fight over the output."""
        found = measured.current.value
        if found is None or not self._output.foreign(found):
            return
        if self._execution is not None:
            self._life.on(Event.FINISH)
            dispute = self._output.dispute(found)
            self._end(Ending(Grip.UNKNOWN, None, dispute), now)
        self._output.adopt(found)

    def _execute(self, measured: Measurement, dt: float, now: Instant) -> None:
        if (execution := self._execution) is None:
            return
        try:
            ending = execution.step(measured, dt)
        except GripperdError as error:
            self.interrupt(no_answer(error), now)
            return
        self._output.current = execution.motion.ramp.current
        self._ledger.put(execution.command)
        if ending is not None:
            self._life.on(Event.FINISH)
            self._end(ending, now)

    def _end(self, ending: Ending, now: Instant) -> None:
        assert self._execution is not None
        command, self._execution = self._execution.command, None
        grip = ending.grip or self._hold.interrupted
        held = ending.held if grip is Grip.HOLDING else None
        limits = command.order or held
        name = None if limits is None else limits.profile.name
        self._hold.settle(grip, name)
        self.keep.begin(held)
        if isinstance(ending.finding, Tared):
            self.zero = Zero(ending.finding.zero, now.wall)
        self._ledger.close(
            replace(command, finding=ending.finding),
            now.wall,
            result=ending.result,
            failure=ending.failure,
        )

    def _cut_short(self, failure: Failure, now: Instant) -> None:
        """End what runs where it is."""
        assert self._execution is not None
        self._end(Ending(None, None, failure, self._execution.held), now)

    def _expire(self, now: Instant) -> None:
        for command, failure in self._ledger.overdue(now):
            if command.status is Status.RUNNING:
                self.interrupt(failure, now)
            else:
                self._ledger.close(command, now.wall, failure=failure)
