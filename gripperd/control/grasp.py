"""One grasp in progress: approach, touch, build up, verify.

The current ramps fast until just before the jaws should meet the object, then slowly
until contact is felt, on to the target, and is kept there while the grip proves itself.
No clock and no I/O: a step takes a measurement and the time since the last one.
"""

from enum import StrEnum

from gripperd.control.command import GraspOrder, GraspResult, Outcome
from gripperd.control.force import ForceSense
from gripperd.control.held import Held
from gripperd.control.plan import Plan
from gripperd.control.profile import Mode
from gripperd.control.proof import DURATION, Proof
from gripperd.control.setpoint import LONGEST_STEP, Ramp, reached, within
from gripperd.model import Chain, Direction
from gripperd.signals import Measurement

CLOSED = 1.5e-3
"""Opening below which the jaws touch each other, not an object. [m]"""
TRIP_MARGIN = 1.15
"""Damage limit over the force at which a grasp is cut short. [-]"""
SETTLE = 0.4
"""Time in which regulator and muscle follow the last step of the current. [s]"""
FOLLOWED = 0.9
"""Share of the wanted pressure that counts as reached. [-]"""
BLIND_AFTER = 0.2
"""How long the jaws wait for a force that is not told. [s]"""
CORRECTION_RATE = 3.0
"""Share of the force error that is corrected in a second. [1/s]"""
CORRECTION_TIME = 4.0
"""Longest time for the force to come within tolerance. [s]"""
TOLERANCE_SHARE = 0.03
TOLERANCE_LEAST = 0.2
"""Force error that counts as none: a share of the target, at least this. [N]"""


class Phase(StrEnum):
    """What a grasp is doing."""

    APPROACH = "approach"
    TOUCH = "touch"
    BUILD = "build"
    VERIFY = "verify"


class Grasp:
    """A grasp from its first step to its outcome.

    Parameters
    ----------
    order
        What to grasp, already found feasible.
    chain
        The model of the gripper.
    current
        Valve current found at the start. [A]
    """

    def __init__(self, order: GraspOrder, chain: Chain, current: float) -> None:
        self.order = order
        self.phase = Phase.APPROACH
        self.ramp = Ramp(current)
        self.elapsed = 0.0
        """Time since the start. [s]"""
        self._chain = chain
        self._plan = Plan(order, chain)
        self._force = ForceSense()
        self._dwell = 0.0
        self._proof: Proof | None = None
        self._eased = False
        self._blind = 0.0
        self._near, self._limit = self._plan.near, self._plan.closing_limit
        self._goal = self._safest = self._plan.goal

    def step(self, measured: Measurement, dt: float) -> Outcome | None:
        """Advance by one period; afterwards ``ramp.current`` is to be written.

        Parameters
        ----------
        measured
            The newest measurement.
        dt
            Time since the last step. [s]

        Returns
        -------
        The outcome when the grasp is over, else None.
        """
        self.elapsed += dt
        self.ramp.tick(dt)
        self._force.update(measured, dt)
        if self._over_limit():
            self._reduce()
            return Outcome.CRUSH_LIMIT
        # A stall of the loop is no time in which anything could be felt.
        dt = min(dt, LONGEST_STEP)
        match self.phase:
            case Phase.APPROACH:
                return self._approach(measured, dt)
            case Phase.TOUCH:
                return self._touch(measured, dt)
            case Phase.BUILD:
                return self._build(measured, dt)
            case Phase.VERIFY:
                return self._verify(measured, dt)

    def rest(self, measured: Measurement) -> None:
        """Let the jaws rest where they are."""
        self.ramp.rest(reached(measured, self._chain))

    def result(self, outcome: Outcome, measured: Measurement) -> GraspResult:
        """What was found, with the model's view beside it."""
        profile, opening = self.order.profile, measured.opening.value
        touched = self._plan.size is not None or self._proof is not None
        predicted = std = None
        if touched and opening is not None:
            found = measured.current.value
            current = self.ramp.current if found is None else found
            predicted, std = self._plan.expected(current, opening, eased=self._eased)
        force = self._proof.force if self._proof else None
        force = self._force.now.value if force is None else force
        slip = crush = None
        if touched and force is not None and force > 0:
            slip = force / profile.slip_force
            crush = profile.damage_force / force
        return GraspResult(
            outcome=outcome,
            size=self._plan.size,
            opening=opening,
            force=force,
            force_quality=self._force.now.quality,
            predicted_force=predicted,
            predicted_std=std,
            current=self.ramp.current,
            pressure=measured.pressure.value,
            slip_margin=slip,
            crush_margin=crush,
            duration=self.elapsed,
        )

    def held(self, outcome: Outcome) -> Held:
        """What is held after an outcome, with the force to keep if it was reached."""
        order = self.order
        reached = outcome is Outcome.HELD and order.mode is Mode.FORCE
        return Held(
            profile=order.profile,
            size=self._plan.size or order.profile.diameter,
            force=order.target if reached else None,
            travel=Direction.EXTENDING if self._eased else Direction.CONTRACTING,
        )

    def _approach(self, measured: Measurement, dt: float) -> Outcome | None:
        if self._force.touching:
            return self._contact(measured)
        # Never opening: what the jaws carry may be too light to be felt.
        goal = max(min(self._near, self._limit), self.ramp.current)
        if self.ramp.towards(goal, self.order.profile.approach, dt):
            self._enter(Phase.TOUCH)
        return None

    def _touch(self, measured: Measurement, dt: float) -> Outcome | None:
        if self._force.touching:
            return self._contact(measured)
        if self._force.now.value is None:
            # Nothing is felt: wait, then go on blind and own up to it at the end.
            self._blind += dt
            if self._blind > BLIND_AFTER:
                self._enter(Phase.BUILD)
            return None
        self._blind = 0.0
        if self.ramp.towards(self._limit, self.order.profile.ramp, dt):
            self._dwell += dt
        if self._dwell <= SETTLE:
            return None
        return (
            Outcome.NO_OBJECT if self._closed(measured) else Outcome.FORCE_NOT_REACHED
        )

    def _closed(self, measured: Measurement) -> bool:
        """Whether the jaws went past where the smallest object would be."""
        profile, opening = self.order.profile, measured.opening.value
        if opening is not None:
            return opening < profile.diameter - profile.smaller
        pressure = measured.pressure.value
        wanted = float(self._chain.outlet.pressure(self.ramp.current))
        return pressure is None or pressure > FOLLOWED * wanted

    def _contact(self, measured: Measurement) -> Outcome | None:
        profile, opening = self.order.profile, measured.opening.value
        if opening is not None:
            # By now the object yields a little to the force that is felt.
            size = opening + (self._force.now.value or 0.0) / profile.stiffness
            self._plan.touch(size)
            verdict = None
            if opening < CLOSED:
                verdict = Outcome.NO_OBJECT
            elif size < profile.diameter - profile.smaller:
                verdict = Outcome.TOO_SMALL
            elif size > profile.diameter + profile.larger:
                verdict = Outcome.TOO_LARGE
            if verdict is not None:
                self.rest(measured)
                return verdict
        self._goal, self._safest = self._plan.goal, self._plan.safest
        self._enter(Phase.BUILD)
        return None

    def _build(self, measured: Measurement, dt: float) -> Outcome | None:
        if self._blind and self._force.touching:
            self._blind = 0.0
            return self._contact(measured)
        if self._strong_enough():
            # The model asks for more than it takes: what is felt decides.
            self.rest(measured)
            self._goal = self.ramp.current
        if not self.ramp.towards(self._goal, self.order.profile.ramp, dt):
            return None
        self._dwell += dt
        if self._dwell < SETTLE:
            return None
        if self.order.mode is Mode.CURRENT or not self._force.measured:
            self._prove(measured)
            return None
        return self._correct(measured, dt)

    def _strong_enough(self) -> bool:
        """Whether a force target is reached before the current that should give it."""
        force = self._force.now.value
        return (
            self.order.mode is Mode.FORCE
            and self._force.measured
            and self.ramp.current < self._goal
            and force is not None
            and force >= self.order.target
        )

    def _correct(self, measured: Measurement, dt: float) -> Outcome | None:
        target, force = self.order.target, self._force.filtered or 0.0
        error = target - force
        if abs(error) <= max(TOLERANCE_SHARE * target, TOLERANCE_LEAST):
            self._prove(measured)
            return None
        if self._dwell > SETTLE + CORRECTION_TIME:
            if error > 0:
                return Outcome.FORCE_NOT_REACHED
            # Friction keeps what the touch had in excess; the limits still hold.
            self._prove(measured)
            return None
        rate = abs(error) * self._plan.current_per_newton(force) * CORRECTION_RATE
        self._goal = self._safest if error > 0 else self._chain.regulator.current_low
        self._eased = self._eased or error < 0
        self.ramp.towards(self._goal, min(rate, self.order.profile.ramp), dt)
        self._goal = self.ramp.current
        return None

    def _prove(self, measured: Measurement) -> None:
        self._proof = Proof(self._force.filtered or 0.0, measured.opening.value)
        self._enter(Phase.VERIFY)

    def _verify(self, measured: Measurement, dt: float) -> Outcome | None:
        self._dwell += dt
        force, proof = self._force.now.value, self._proof
        assert proof is not None
        if force is None:
            return Outcome.UNKNOWN if self._dwell > DURATION else None
        proof.add(force)
        if proof.slipped(self._force.filtered or 0.0, measured):
            return Outcome.SLIPPED
        if self._dwell <= DURATION:
            return None
        profile = self.order.profile
        enough = (proof.force or 0.0) >= profile.slip_force * profile.slip_margin
        return Outcome.HELD if enough else Outcome.FORCE_NOT_REACHED

    def _over_limit(self) -> bool:
        force = self._force.now.value
        highest = self.order.profile.damage_force / TRIP_MARGIN
        return force is not None and force > highest

    def _reduce(self) -> None:
        """Take the force back to the safe side: venting would drop the object."""
        self._eased = True
        # What is felt belongs to the current of a moment ago; the valve is in doubt.
        self.ramp.rest(None)
        reduced = self.ramp.current - self._plan.reduction(self._force.now.value or 0.0)
        self.ramp.current = within(self._chain.regulator, reduced)

    def _enter(self, phase: Phase) -> None:
        self.phase = phase
        self._dwell = 0.0
