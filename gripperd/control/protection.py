"""Monitoring, faults and reactions of one gripper, as one.

Every sample is watched, what is wrong is written down, and what the policy of a latched
cause wants is carried out. As long as nothing is latched the current is left alone.
"""

from collections.abc import Mapping
from dataclasses import dataclass

from gripperd.control.command import Failure
from gripperd.control.dispatch import Dispatch
from gripperd.control.fault import Fault
from gripperd.control.faults import Faults
from gripperd.control.hold import Hold
from gripperd.control.lifecycle import Lifecycle
from gripperd.control.monitors.output import overruled
from gripperd.control.monitors.panel import Panel
from gripperd.control.monitors.policy import (
    OPENING,
    STRENGTH,
    Cause,
    Policy,
    Reaction,
)
from gripperd.control.monitors.sight import Scatter, Sight, Symptom
from gripperd.control.monitors.tightened import check_tightened, tightened
from gripperd.control.output import Output
from gripperd.control.profile import Profile
from gripperd.control.reaction import Ease, Response, response
from gripperd.control.snapshot import Instant
from gripperd.control.states import BOUND, Event, Grip, Machine
from gripperd.errors import Refused
from gripperd.model import Chain
from gripperd.signals import Measurement

REACTING = frozenset({Machine.FAULT_REACTION, Machine.ESTOPPED})
"""States in which the jaws may move by themselves."""
STILL = frozenset({Reaction.HOLD, Reaction.FREEZE})
"""Reactions that move nothing."""


@dataclass(frozen=True, slots=True)
class Sample:
    """What is measured, and what it is to be judged by."""

    measured: Measurement
    scatter: Scatter
    chain: Chain
    contacts: tuple[tuple[Symptom, Policy], ...] = ()
    """Interlocks that are open."""


class Protection:
    """Stands between what is seen and what may go on.

    Parameters
    ----------
    faults
        Where they are written down.
    life, dispatch, output, hold
        Of the gripper.
    policies
        What counts, and what is done about it.
    """

    def __init__(
        self,
        faults: Faults,
        life: Lifecycle,
        dispatch: Dispatch,
        output: Output,
        hold: Hold,
        policies: Mapping[Cause, Policy],
    ) -> None:
        self._faults = faults
        self._life = life
        self._dispatch = dispatch
        self._output = output
        self._hold = hold
        self._policies = policies
        self._panel = Panel()
        self._response: Response | None = None
        self._reaction = Reaction.HOLD

    @property
    def reacting(self) -> bool:
        """Whether a reaction is being carried out."""
        return self._response is not None and self._life.state in REACTING

    def watch(self, sample: Sample, dt: float, now: Instant) -> None:
        """Look at one sample, and stop what may not go on."""
        sight = self._sight(sample)
        symptoms = [*self._panel.look(sight, dt), *overruled(self._output, sight)]
        told = ((symptom, sight.policies[symptom.cause]) for symptom in symptoms)
        raised = self._faults.update((*told, *sample.contacts), dt, now)
        latched = [fault for fault in raised if fault.latched]
        if latched:
            worst = max(latched, key=_rank)
            self._respond(worst, worst.reaction, sight, now)
        elif self._faults.latched and self._life.state not in BOUND:
            # It outlived a lost link or an emergency stop; nothing moves for it again.
            self._respond(self._faults.latched[0], Reaction.HOLD, sight, now)

    def step(self, measured: Measurement, dt: float) -> None:
        """Advance the reaction by one period."""
        if self._response is None or not self.reacting:
            self._response = None
            return
        ended = self._response.step(measured, dt)
        self._output.current = self._response.ramp.current
        if ended is None:
            return
        if self._life.state is Machine.FAULT_REACTION:
            self._life.on(Event.REACTED)
        self._response = None
        if self._reaction in OPENING:
            self._hold.settle(Grip.RELEASED if ended else Grip.UNKNOWN, None)

    def freeze(self, measured: Measurement | None) -> None:
        """Stop a reaction where it is."""
        if self.reacting and measured is not None:
            self._interrupt(measured)
            current = self._output.current
            self._reaction, self._response = Reaction.FREEZE, Ease(current, current)

    def forget(self) -> None:
        """Carry out nothing any more; a lost link has ended it."""
        self._response = None

    def check_rest(self) -> None:
        """Refuse to go on while a reaction still opens the jaws.

        Raises
        ------
        Refused
            One does.
        """
        if self.reacting and self._reaction in OPENING:
            message = f"the jaws are still opening: {self._reaction}"
            raise Refused(message, code="wrong-state", hints=("wait", "or stop them"))

    def check(self, profile: Profile) -> None:
        """Refuse a profile that wants to be watched less closely than the gripper is.

        Raises
        ------
        Refused
            With both limits.
        """
        check_tightened(self._policies, profile)

    def _sight(self, sample: Sample) -> Sight:
        held = self._dispatch.keep.held
        profile = None if held is None else held.profile
        reacts = self.reacting and self._reaction not in STILL
        moving = reacts or self._life.state is Machine.STOPPING
        return Sight(
            measured=sample.measured,
            scatter=sample.scatter,
            current=self._output.written,
            chain=sample.chain,
            grip=self._hold.grip,
            idle=not moving and self._dispatch.running is None,
            policies=tightened(self._policies, profile),
            profile=profile,
        )

    def _respond(
        self, fault: Fault, reaction: Reaction, sight: Sight, now: Instant
    ) -> None:
        self._dispatch.rest()
        failure = Failure(category="fault", code=fault.cause, message=fault.message)
        self._dispatch.end_all(failure, now)
        estop = fault.cause is Cause.ESTOPPED
        if self.reacting:
            if not estop and STRENGTH[reaction] <= STRENGTH[self._reaction]:
                return
            self._interrupt(sight.measured)
        self._life.on(Event.FAIL)
        # An emergency stop is the end of everything but its own reaction.
        if estop or self._life.state is Machine.FAULT_REACTION:
            self._begin(reaction, sight)

    def _interrupt(self, measured: Measurement) -> None:
        """Let the jaws rest where they are by now."""
        assert self._response is not None
        self._response.rest(measured)
        self._output.current = self._response.ramp.current
        if self._reaction in OPENING:
            self._hold.settle(self._hold.interrupted, None)

    def _begin(self, reaction: Reaction, sight: Sight) -> None:
        self._reaction = reaction
        self._response = response(reaction, self._output.current, sight)
        if reaction in OPENING:
            self._hold.settle(Grip.RELEASING, None)


def _rank(fault: Fault) -> tuple[bool, int]:
    """Which of several faults is reacted to."""
    return fault.cause is Cause.ESTOPPED, STRENGTH[fault.reaction]
