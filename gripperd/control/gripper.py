"""One gripper: what it is allowed to do, what it does, what it holds.

Without clock and I/O. Each period the loop passes in a measurement and gets back the
current to write, or None where nothing has to change.
"""

from collections.abc import Callable

from gripperd.control.command import (
    CANCELLED,
    OBJECT_HELD,
    STOPPED,
    Command,
    Failure,
    GraspOrder,
    Status,
    no_answer,
)
from gripperd.control.evaluation import check
from gripperd.control.execution import Ending, Execution
from gripperd.control.hold import Hold
from gripperd.control.ledger import Key, Ledger
from gripperd.control.output import Output
from gripperd.control.senses import Senses
from gripperd.control.snapshot import GripperState, Instant
from gripperd.control.states import Event, Grip, Machine, after, possible
from gripperd.errors import GripperdError, Refused
from gripperd.model import Chain
from gripperd.signals import Measurement

ATTACH_SAMPLES = 3
"""Measurements taken before the present state is believed and adopted."""
STOP_TIME = 0.3
"""Regulator and muscle are at rest after this. [s]"""


class Gripper:
    """The control of one gripper.

    Parameters
    ----------
    name, chain
        As in the configuration.
    auto_enable
        Enable by itself after attaching; never moves.
    identify
        Gives a new command its id.
    """

    def __init__(
        self, name: str, chain: Chain, *, auto_enable: bool, identify: Callable[[], str]
    ) -> None:
        self.name = name
        self.chain = chain
        self.machine = Machine.OFFLINE
        self.ledger = Ledger(name, identify)
        self._enabled = auto_enable
        self.link = "not connected yet"
        self._output = Output()
        self._measured: Measurement | None = None
        self._senses = Senses(chain)
        self.hold = Hold()
        self._execution: Execution | None = None
        self._dwell = 0.0
        self._samples = 0

    def submit(
        self, order: GraspOrder | None, deadline: float, key: Key | None, now: Instant
    ) -> tuple[Command, bool]:
        """Accept a command, or give the one its key stands for already, and True.

        Parameters
        ----------
        order
            What to grasp; None to release.
        deadline
            Longest time until the command is over. [s]
        key
            The client's idempotency key.

        Raises
        ------
        Refused
            Not now, or not at all.
        InputError
            The key was used for another request.
        """
        if (known := self.ledger.replay(key)) is not None:
            return known, True
        if self.machine is not Machine.EXECUTING:
            after(self.machine, Event.START)
        if order is not None:
            self._check_free()
            check(order, self.chain)
        return self.ledger.accept(order, deadline, key, now), False

    def stop(self, now: Instant) -> float | None:
        """Freeze: end every command and let the jaws rest. Never releases.

        Returns the current to write at once, None where it stays. [A]
        """
        self._freeze()
        self._end_all(STOPPED, now)
        return self._output.change()

    def cancel(self, command_id: str, now: Instant) -> float | None:
        """End one command; if it runs, freeze as by :meth:`stop`, returning the same.

        Raises
        ------
        NotFound, Refused
            No such command; or it is over already.
        """
        command = self.ledger.get(command_id)
        if command.final:
            message = f"command {command_id} is over: {command.status}"
            raise Refused(message, code="already-final")
        if self._execution is None or self._execution.command.id != command_id:
            self.ledger.close(command, now.wall, failure=CANCELLED)
            return None
        self._interrupt(CANCELLED, now)
        return self._output.change()

    @property
    def attached(self) -> bool:
        """Whether the present state of the hardware is known."""
        return self.machine not in {Machine.OFFLINE, Machine.ATTACHING}

    def enable(self) -> None:
        """Allow commands; nothing moves."""
        self.machine = after(self.machine, Event.ENABLE)
        self._enabled = True

    def disable(self, now: Instant) -> None:
        """Allow no more commands, nor those that wait; the current stays."""
        self.machine = after(self.machine, Event.DISABLE)
        self._enabled = False
        self._end_all(CANCELLED, now)

    def state(self, now: Instant) -> GripperState:
        """Snapshot for whoever asks."""
        measured = self._measured
        running = self._execution
        return GripperState(
            name=self.name,
            machine=self.machine,
            grip=self.hold.grip,
            available_transitions=possible(self.machine),
            adopted=self._output.adopted,
            current=self._output.current if self.attached else None,
            measured=measured,
            age=None if measured is None else now.monotonic - measured.time,
            command=None if running is None else running.command.id,
            holding=self.hold.profile,
            link=self.link,
            model=self.chain.name,
        )

    def use(self, chain: Chain) -> None:
        """Go by another model from the next period on; nothing is written."""
        self.chain = chain
        self._senses = Senses(chain)

    def link_lost(self, why: str, now: Instant) -> None:
        """Nothing can be read or written; the module keeps the last current."""
        self.link = why
        if self.machine is Machine.OFFLINE:
            return
        self.machine = after(self.machine, Event.LINK_LOST)
        self._end_all(Failure(category="fault", code="link-lost", message=why), now)
        self.hold.settle(Grip.UNKNOWN, None)

    def period(self, raw: Measurement, dt: float, now: Instant) -> float | None:
        """Advance by one period on a fresh sample.

        Returns
        -------
        The current to write, None where it stays. [A]
        """
        measured = self._measured = self._senses.judge(raw, dt)
        self.link = "up"
        self.hold.update(measured, dt)
        match self.machine:
            case Machine.OFFLINE:
                self.machine = after(self.machine, Event.LINK_UP)
                self._samples = 0
                return None
            case Machine.ATTACHING:
                self._attach(measured)
                return None
            case Machine.READY:
                self._start_next(now)
            case Machine.STOPPING:
                self._dwell += dt
                if self._dwell > STOP_TIME:
                    self.machine = after(self.machine, Event.REST)
            case _:
                pass
        self._notice_foreign_write(measured, now)
        self._execute(measured, dt, now)
        self._expire(now)
        self.hold.look(adopted=self._output.adopted and self._execution is None)
        return self._output.change()

    def _check_free(self) -> None:
        objection = self.objection
        if objection and not self.ledger.releases_first:
            raise Refused(objection, code="object-held", hints=("release first",))

    @property
    def objection(self) -> str | None:
        """Why a grasp now could let go of something; None when it could not."""
        low = self.chain.regulator.current_low
        return self.hold.objection(vented=self._output.current <= low)

    def _attach(self, measured: Measurement) -> None:
        """Take over what is there; nothing is written before this."""
        self._samples += 1
        if measured.current.value is None or self._samples < ATTACH_SAMPLES:
            return
        self._output.adopt(measured.current.value)
        self.hold.adopt()
        self.machine = after(self.machine, Event.ADOPT)
        if self._enabled:
            self.enable()

    def _start_next(self, now: Instant) -> None:
        if (command := self.ledger.next()) is None:
            return
        if command.order is not None and self.objection:
            self.ledger.close(command, now.wall, failure=OBJECT_HELD)
            return
        current = self._output.current
        try:
            self._execution = Execution(command, self.chain, current, now.wall)
        except GripperdError as error:
            self.ledger.close(command, now.wall, failure=no_answer(error))
            return
        self.machine = after(self.machine, Event.START)
        self.ledger.put(self._execution.command)
        self.hold.settle(self._execution.grip, None)

    def _execute(self, measured: Measurement, dt: float, now: Instant) -> None:
        if (execution := self._execution) is None:
            return
        try:
            ending = execution.step(measured, dt)
        except GripperdError as error:
            self._interrupt(no_answer(error), now)
            return
        self._output.current = execution.motion.ramp.current
        self.ledger.put(execution.command)
        if ending is not None:
            self.machine = after(self.machine, Event.FINISH)
            self._end(ending, now)

    def _end(self, ending: Ending, now: Instant) -> None:
        assert self._execution is not None
        command, self._execution = self._execution.command, None
        order = command.order
        self.hold.settle(ending.grip, None if order is None else order.profile.name)
        self.ledger.close(
            command, now.wall, result=ending.result, failure=ending.failure
        )

    def _end_all(self, failure: Failure, now: Instant) -> None:
        if self._execution is not None:
            self._end(Ending(self.hold.interrupted, None, failure), now)
        for command in self.ledger.waiting():
            self.ledger.close(command, now.wall, failure=failure)

    def _interrupt(self, failure: Failure, now: Instant) -> None:
        self._freeze()
        self._end(Ending(self.hold.interrupted, None, failure), now)

    def _freeze(self) -> None:
        """Let the jaws rest where they are: the pressure lags behind the current."""
        self.machine = after(self.machine, Event.STOP)
        self._dwell = 0.0
        if self._execution is not None and self._measured is not None:
            self._execution.motion.rest(self._measured)
            self._output.current = self._execution.motion.ramp.current

    def _notice_foreign_write(self, measured: Measurement, now: Instant) -> None:
        """Adopt a current that something else has set; never fight over the output."""
        found = measured.current.value
        if found is None or not self._output.foreign(found):
            return
        if self._execution is not None:
            self.machine = after(self.machine, Event.FINISH)
            dispute = self._output.dispute(found)
            self._end(Ending(Grip.UNKNOWN, None, dispute), now)
        self._output.adopt(found)

    def _expire(self, now: Instant) -> None:
        for command, failure in self.ledger.overdue(now):
            if command.status is Status.RUNNING:
                self._interrupt(failure, now)
            else:
                self.ledger.close(command, now.wall, failure=failure)
