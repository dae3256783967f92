"""One gripper: what it is allowed to do, what it does, what it holds.

Without clock and I/O. Each period the loop passes in a measurement and gets back the
current to write, or None where nothing has to change.
"""

from collections.abc import Callable

from gripperd.control.command import (
    CANCELLED,
    STOPPED,
    Command,
    Failure,
    GraspOrder,
    Order,
)
from gripperd.control.dispatch import Dispatch
from gripperd.control.evaluation import check
from gripperd.control.faults import Faults
from gripperd.control.hold import Hold
from gripperd.control.ledger import Key, Ledger
from gripperd.control.lifecycle import Lifecycle
from gripperd.control.monitors.policy import AS_SHIPPED, Monitoring
from gripperd.control.output import Output
from gripperd.control.permission import Permission
from gripperd.control.protection import Protection, Sample
from gripperd.control.senses import Senses
from gripperd.control.snapshot import GripperState, Instant
from gripperd.control.states import Event, Machine
from gripperd.control.tare import tared
from gripperd.control.zero import Zero
from gripperd.errors import Refused
from gripperd.model import Chain
from gripperd.signals import Measurement

ATTACH_SAMPLES = 3
"""Measurements taken before the present state is believed and adopted."""


class Gripper:
    """The control of one gripper.

    Parameters
    ----------
    name, chain
        As in the configuration.
    auto_enable
        Enable by itself after attaching; never moves.
    identify
        Gives a new command or fault its id.
    monitoring
        What counts as a fault, and what is done about it.
    """

    def __init__(
        self,
        name: str,
        chain: Chain,
        *,
        auto_enable: bool,
        identify: Callable[[], str],
        monitoring: Monitoring = AS_SHIPPED,
    ) -> None:
        self.name = name
        self.chain = chain
        self.ledger = Ledger(name, identify)
        self.hold = Hold()
        self.link = "not connected yet"
        self._enabled = auto_enable
        self._life = Lifecycle()
        self._output = Output()
        self._dispatch = Dispatch(self._life, self.ledger, self._output, self.hold)
        self.permission = Permission(
            self._life, self._dispatch, self.ledger.journal, monitoring.policies
        )
        self.faults = Faults(name, identify, self.ledger.journal)
        self._protection = Protection(
            self.faults,
            self._life,
            self._dispatch,
            self._output,
            self.hold,
            monitoring.policies,
        )
        self._senses = Senses(chain, monitoring.spans)
        self._measured: Measurement | None = None
        self._samples = 0

    @property
    def machine(self) -> Machine:
        """What it is allowed to do."""
        return self._life.state

    @property
    def zero(self) -> Zero:
        """Of the force sensor."""
        return self._dispatch.zero

    @zero.setter
    def zero(self, zero: Zero) -> None:
        self._dispatch.zero = zero

    @property
    def attached(self) -> bool:
        """Whether the present state of the hardware is known."""
        return self._life.attached

    def submit(
        self, order: Order, deadline: float, key: Key | None, now: Instant
    ) -> tuple[Command, bool]:
        """Accept a command, or give the one its key stands for already, and True.

        Parameters
        ----------
        order
            What to grasp or to do; None to release.
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
        self.permission.expire(now)
        self.faults.check()
        if self.machine is not Machine.EXECUTING:
            self._life.check(Event.START)
        self.permission.check()
        if isinstance(order, GraspOrder):
            self._check_free()
            self._protection.check(order.profile)
            check(order, self.chain)
        elif order is not None:
            self._dispatch.check(order, self.chain, self._measured)
        return self.ledger.accept(order, deadline, key, now), False

    def stop(self, now: Instant) -> float | None:
        """Freeze: end every command and let the jaws rest. Never releases.

        Returns the current to write at once, None where it stays. [A]
        """
        self._dispatch.freeze()
        self._protection.freeze(self._measured)
        self._dispatch.end_all(STOPPED, now)
        return self._output.change()

    def cancel(self, command_id: str, now: Instant) -> float | None:
        """End one command; if it runs, freeze as by :meth:`stop`, returning the same.

        Raises
        ------
        NotFound, Refused
            No such command; or it is over already.
        """
        self._dispatch.cancel(self.ledger.get(command_id), now)
        return self._output.change()

    def enable(self) -> None:
        """Allow commands; nothing moves.

        Raises
        ------
        Refused
            Something is latched, or there is nothing to enable.
        """
        self.faults.check()
        self._life.on(Event.ENABLE)
        self._enabled = True

    def disable(self, now: Instant) -> None:
        """Allow no more commands, nor those that wait; the current stays."""
        self._life.on(Event.DISABLE)
        self._enabled = False
        self._dispatch.end_all(CANCELLED, now)

    def reset(self, now: Instant) -> None:
        """Leave a fault or an emergency stop for `disabled`; nothing moves.

        Raises
        ------
        Refused
            There is none, it was not acknowledged, or its cause is still there.
        """
        if self.machine is Machine.ESTOPPED:
            self.permission.check_reset()
            self._protection.check_rest()
            self.faults.reset_estop(now)
        else:
            self._life.check(Event.RESET)
            self.faults.reset(now)
        self._life.on(Event.RESET)
        self._enabled = False

    def state(self, now: Instant) -> GripperState:
        """Snapshot for whoever asks."""
        measured = self._measured
        return GripperState(
            name=self.name,
            machine=self.machine,
            grip=self.hold.grip,
            available_transitions=self._life.possible,
            adopted=self._output.adopted,
            current=self._output.current if self.attached else None,
            measured=measured,
            age=None if measured is None else now.monotonic - measured.time,
            command=self._dispatch.running,
            holding=self.hold.profile,
            link=self.link,
            model=self.chain.name,
            model_digest=self.chain.digest,
            held=self._dispatch.keep.held,
            strongest=self.hold.strongest,
            regulation=self._dispatch.keep.state(measured),
            faults=self.faults.active,
            zero=self.zero,
        )

    def use(self, chain: Chain) -> None:
        """Go by another model from the next period on; nothing is written."""
        self.chain = chain
        self._senses.use(chain)

    def link_lost(self, why: str, now: Instant) -> None:
        """Nothing can be read or written; the module keeps the last current."""
        self.link = why
        if self.machine is Machine.OFFLINE:
            return
        seen = self.attached
        self._life.on(Event.LINK_LOST)
        self._protection.forget()
        lost = Failure(category="fault", code="link-lost", message=why)
        self._dispatch.end_all(lost, now)
        if seen:
            self.hold.lose_sight()

    def period(self, raw: Measurement, dt: float, now: Instant) -> float | None:
        """Advance by one period on a fresh sample.

        Returns
        -------
        The current to write, None where it stays. [A]
        """
        measured = self._measured = self._senses.judge(tared(raw, self.zero.force), dt)
        self.link = "up"
        self.hold.update(measured, dt)
        self.permission.update(measured)
        if not self.attached:
            self._attach(measured)
            return None
        self.permission.enforce(now)
        contacts = self.permission.symptoms
        sample = Sample(measured, self._senses.scatter, self.chain, contacts)
        self._protection.watch(sample, dt, now)
        if self.machine is Machine.READY:
            self._dispatch.start_next(self.chain, measured, now)
        self._dispatch.step(measured, dt, now)
        self._protection.step(measured, dt)
        idle = self._dispatch.running is None
        self.hold.look(adopted=self._output.adopted and idle)
        if idle and self._dispatch.running is None:
            self._dispatch.look_after(measured, self.chain, dt)
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
        if self.machine is Machine.OFFLINE:
            self._life.on(Event.LINK_UP)
            self._samples = 0
            return
        self._samples += 1
        if measured.current.value is None or self._samples < ATTACH_SAMPLES:
            return
        ours = self._output.adopt(measured.current.value)
        self._dispatch.resume(same=ours and self.hold.unmoved)
        self.permission.begin()
        self._life.on(Event.ADOPT)
        if self._enabled and not self.faults.latched:
            self.enable()
