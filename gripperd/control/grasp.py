"""One grasp in progress: approach, touch, build up, verify.

The current ramps fast until just before the jaws should meet the object, then slowly
until contact is felt, on to the target, and is kept there while the grip proves itself.
No clock and no I/O: a step takes a measurement and the time since the last one.
"""

from dataclasses import dataclass, replace
from enum import StrEnum

from gripperd.control.command import GraspOrder, GraspResult, Outcome
from gripperd.control.force import CONTACT_FORCE, ForceSense
from gripperd.control.profile import Mode
from gripperd.control.setpoint import at_rest, ramped, within
from gripperd.model import Chain, PressedObject
from gripperd.signals import Measurement

CLEARANCE = 2e-3
"""How far before the largest allowed object the slow ramp begins. [m]"""
CLOSED = 1.5e-3
"""Opening below which the jaws touch each other, not an object. [m]"""
TRIP_MARGIN = 1.15
"""Damage limit over the force at which a grasp is cut short. [-]"""
SETTLE = 0.4
"""Time in which regulator and muscle follow the last step of the current. [s]"""
PROOF = 0.7
"""How long a grip must prove itself: a slipping object falls 20 mm meanwhile. [s]"""
CORRECTION_RATE = 3.0
"""Share of the force error that is corrected in a second. [1/s]"""
CORRECTION_TIME = 4.0
"""Longest time for the force to come within tolerance. [s]"""
TOLERANCE_SHARE = 0.02
TOLERANCE_LEAST = 0.1
"""Force error that counts as none: a share of the target, at least this. [N]"""
SLIP_DROP = 0.5
"""Share of the force that may vanish while the grip proves itself. [-]"""
SLIP_TRAVEL = 2e-3
"""Closing of the jaws that tells of a lost object meanwhile. [m]"""


class Phase(StrEnum):
    """What a grasp is doing."""

    APPROACH = "approach"
    TOUCH = "touch"
    BUILD = "build"
    VERIFY = "verify"


@dataclass(frozen=True, slots=True)
class Proof:
    """What the grip was when it began to prove itself, and the force since."""

    force: float
    opening: float | None
    total: float = 0.0
    samples: int = 0


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
        self.current = current
        """Valve current asked for. [A]"""
        self.elapsed = 0.0
        """Time since the start. [s]"""
        self.size: float | None = None
        """Opening at first contact. [m]"""
        self._chain = chain
        self._force = ForceSense(chain)
        self._dwell = 0.0
        self._proof: Proof | None = None
        self._goal = self._goal_for(order.profile.pressed)
        self._limit = self._closing_limit()

    def step(self, measured: Measurement, dt: float) -> Outcome | None:
        """Advance by one period; afterwards `current` is what to write.

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
        self._force.update(measured, dt)
        if self._over_limit():
            self._reduce()
            return Outcome.CRUSH_LIMIT
        match self.phase:
            case Phase.APPROACH:
                return self._approach(measured, dt)
            case Phase.TOUCH:
                return self._touch(measured, dt)
            case Phase.BUILD:
                return self._build(measured, dt)
            case Phase.VERIFY:
                return self._verify(measured, dt)

    def result(self, outcome: Outcome, measured: Measurement) -> GraspResult:
        """What was found, with the model's view beside it."""
        profile, opening = self.order.profile, measured.opening.value
        force = self._proven_force()
        predicted = std = None
        if opening is not None:
            predicted = max(float(self._chain.grip_force(self.current, opening)), 0.0)
            std = self._chain.std(self.current, PressedObject(opening))
        held = force is not None and force > 0
        return GraspResult(
            outcome=outcome,
            size=self.size,
            opening=opening,
            force=force,
            force_quality=self._force.now.quality,
            predicted_force=predicted,
            predicted_std=std,
            current=self.current,
            pressure=measured.pressure.value,
            slip_margin=force / profile.slip_force if held and force else None,
            crush_margin=profile.damage_force / force if held and force else None,
            duration=self.elapsed,
        )

    def _approach(self, measured: Measurement, dt: float) -> Outcome | None:
        if self._force.touching:
            return self._contact(measured)
        profile, linkage = self.order.profile, self._chain.linkage
        widest = profile.diameter + profile.larger + CLEARANCE
        near = float(self._chain.current(0.0, min(widest, linkage.open_width)))
        if self._ramp_to(min(near, self._limit), profile.approach * dt):
            self._enter(Phase.TOUCH)
        return None

    def _touch(self, measured: Measurement, dt: float) -> Outcome | None:
        if self._force.touching:
            return self._contact(measured)
        if self._force.now.value is None:
            # Nothing can be felt: go on blind, and own up to it at the end.
            self._enter(Phase.BUILD)
            return None
        if self._ramp_to(self._limit, self.order.profile.ramp * dt):
            self._dwell += dt
        return Outcome.NO_OBJECT if self._dwell > SETTLE else None

    def _contact(self, measured: Measurement) -> Outcome | None:
        profile = self.order.profile
        self.size = measured.opening.value
        if self.size is not None:
            verdict = None
            if self.size < CLOSED:
                verdict = Outcome.NO_OBJECT
            elif self.size < profile.diameter - profile.smaller:
                verdict = Outcome.TOO_SMALL
            elif self.size > profile.diameter + profile.larger:
                verdict = Outcome.TOO_LARGE
            if verdict is not None:
                self.current = at_rest(measured, self._chain, self.current)
                return verdict
            self._goal = self._goal_for(replace(profile.pressed, diameter=self.size))
        self._enter(Phase.BUILD)
        return None

    def _build(self, measured: Measurement, dt: float) -> Outcome | None:
        if not self._ramp_to(self._goal, self.order.profile.ramp * dt):
            return None
        self._dwell += dt
        if self._dwell < SETTLE:
            return None
        if self.order.mode is Mode.CURRENT or not self._force.measured:
            self._prove(measured)
            return None
        return self._correct(measured, dt)

    def _correct(self, measured: Measurement, dt: float) -> Outcome | None:
        target, force = self.order.target, self._force.filtered or 0.0
        error = target - force
        if abs(error) <= max(TOLERANCE_SHARE * target, TOLERANCE_LEAST):
            self._prove(measured)
            return None
        if self._dwell > SETTLE + CORRECTION_TIME:
            return Outcome.FORCE_NOT_REACHED
        change = error * self._current_per_newton() * CORRECTION_RATE * dt
        limit = self.order.profile.ramp * dt
        goal = self._goal + min(max(change, -limit), limit)
        self._goal = self.current = within(self._chain.regulator, goal)
        return None

    def _prove(self, measured: Measurement) -> None:
        self._proof = Proof(self._force.filtered or 0.0, measured.opening.value)
        self._enter(Phase.VERIFY)

    def _verify(self, measured: Measurement, dt: float) -> Outcome | None:
        self._dwell += dt
        force, proof = self._force.now.value, self._proof
        assert proof is not None
        if force is None:
            return Outcome.UNKNOWN if self._dwell > PROOF else None
        total, samples = proof.total + force, proof.samples + 1
        self._proof = replace(proof, total=total, samples=samples)
        if self._slipping(measured, proof):
            return Outcome.SLIPPED
        if self._dwell <= PROOF:
            return None
        profile = self.order.profile
        enough = total / samples >= profile.slip_force * profile.slip_margin
        return Outcome.HELD if enough else Outcome.FORCE_NOT_REACHED

    def _slipping(self, measured: Measurement, proof: Proof) -> bool:
        if (self._force.filtered or 0.0) < SLIP_DROP * proof.force:
            return True
        now, then = measured.opening.value, proof.opening
        return now is not None and then is not None and now < then - SLIP_TRAVEL

    def _over_limit(self) -> bool:
        force = self._force.now.value
        highest = self.order.profile.damage_force / TRIP_MARGIN
        return self._force.measured and force is not None and force > highest

    def _reduce(self) -> None:
        """Take the force back to the safe side: venting would drop the object."""
        profile, force = self.order.profile, self._force.now.value or 0.0
        excess = max(force - profile.damage_force / profile.crush_margin, 0.0)
        reduced = self.current - excess * self._current_per_newton()
        self.current = within(self._chain.regulator, reduced)

    def _proven_force(self) -> float | None:
        if self._proof is not None and self._proof.samples:
            return self._proof.total / self._proof.samples
        return self._force.now.value

    def _current_per_newton(self) -> float:
        """Change of current for a change of grip force, at the object. [A/N]."""
        force, pressed = self._force.filtered or 0.0, self.order.profile.pressed
        more = self._chain.current_for(force + 1.0, pressed)
        return more - self._chain.current_for(force, pressed)

    def _goal_for(self, pressed: PressedObject) -> float:
        if self.order.mode is Mode.CURRENT:
            return self.order.target
        current = self._chain.current_for(self.order.target, pressed)
        return within(self._chain.regulator, current)

    def _closing_limit(self) -> float:
        """Current beyond which closing on nothing is not pursued. [A]."""
        if self.order.mode is Mode.CURRENT:
            return self.order.target
        closed = float(self._chain.current(CONTACT_FORCE, 0.0))
        return within(self._chain.regulator, max(closed, self._goal))

    def _ramp_to(self, goal: float, step: float) -> bool:
        self.current = ramped(self.current, goal, step)
        return self.current == goal

    def _enter(self, phase: Phase) -> None:
        self.phase = phase
        self._dwell = 0.0
