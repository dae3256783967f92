"""Another force on what is held: there by the model, then corrected, then proven."""

from gripperd.control.command import Outcome
from gripperd.control.ending import Ending
from gripperd.control.force import ForceSense
from gripperd.control.force_loop import QUICK
from gripperd.control.grasp import (
    CORRECTION_TIME,
    TOLERANCE_LEAST,
    TOLERANCE_SHARE,
    TRIP_MARGIN,
)
from gripperd.control.held import Held
from gripperd.control.keeping import kept
from gripperd.control.profile import Mode
from gripperd.control.proof import DURATION, Proof
from gripperd.control.regulation import Regulation
from gripperd.control.setpoint import LONGEST_STEP, Ramp, reached
from gripperd.control.trust import Level
from gripperd.control.watch import LOST_SAMPLES
from gripperd.model import Chain
from gripperd.signals import Measurement

STEADY = 0.3
"""How long the smoothed force has to be there: three times its smoothing. [s]"""


class Adjustment:
    """One adjustment from its first step to its outcome.

    Parameters
    ----------
    aim
        Current [A] or force per jaw [N], already found to be within the limits.
    held
        What is held.
    chain
        The model of the gripper.
    current
        Valve current at the start. [A]
    """

    def __init__(
        self, aim: tuple[Mode, float], held: Held, chain: Chain, current: float
    ) -> None:
        self.ramp = Ramp(current)
        self.held = held
        """What is held, as it is to be held from now on."""
        self._aim = aim
        self._chain = chain
        self._regulation: Regulation | None = None
        self._proof: Proof | None = None
        self._force = ForceSense()
        self._missing = 0
        self._elapsed = self._waited = self._near = self._proven = 0.0

    def step(self, measured: Measurement, dt: float) -> Ending | None:
        """Advance by one period; write ``ramp.current`` afterwards."""
        self._elapsed += dt
        self.ramp.tick(dt)
        regulation = self._regulation or self._begin(measured)
        self.ramp.current = regulation.step(measured, dt)
        self.held = regulation.held
        # A stall of the loop is no time in which anything could be corrected.
        dt = min(dt, LONGEST_STEP)
        if self._over_limit(measured):
            self.ramp.current = regulation.reduce()
            self.held = regulation.held
            return self._ended(Outcome.CRUSH_LIMIT, measured)
        if self._lost(measured, dt):
            return self._ended(Outcome.SLIPPED, measured)
        if self._proof is not None:
            return self._verify(self._proof, measured, dt)
        if not regulation.settled:
            return None
        self._waited += dt
        return self._judge(regulation, measured, dt)

    def rest(self, measured: Measurement) -> None:
        """Stop here; the object stays held, with the current as it is."""
        self.ramp.rest(reached(measured, self._chain))
        self.held = self.held.at(None, self.held.travel)

    def _begin(self, measured: Measurement) -> Regulation:
        (mode, target), held = self._aim, self.held
        self._regulation = regulation = Regulation(
            held, self._chain, self.ramp.current, felt=measured.grip.value, closed=QUICK
        )
        if mode is Mode.CURRENT:
            regulation.aim_current(target)
        else:
            regulation.aim(target)
        return regulation

    def _judge(
        self, regulation: Regulation, measured: Measurement, dt: float
    ) -> Ending | None:
        """Whether the force is there, once the pressure is."""
        wanted, felt = self.held.force, regulation.felt
        level = regulation.state.level
        if wanted is None or felt is None or level is not Level.FORCE:
            self._prove(regulation, measured)
            return None
        error = wanted - felt
        near = abs(error) <= max(TOLERANCE_SHARE * wanted, TOLERANCE_LEAST)
        self._near = self._near + dt if near else 0.0
        if self._near > STEADY:
            self._prove(regulation, measured)
            return None
        if self._waited < CORRECTION_TIME:
            return None
        return self._ended(Outcome.FORCE_NOT_REACHED, measured)

    def _prove(self, regulation: Regulation, measured: Measurement) -> None:
        self._proof = Proof(regulation.felt or 0.0, measured.opening.value)

    def _verify(self, proof: Proof, measured: Measurement, dt: float) -> Ending | None:
        self._proven += dt
        force = measured.grip.value
        if force is None:
            over = self._proven > DURATION
            return self._ended(Outcome.UNKNOWN, measured) if over else None
        proof.add(force)
        assert self._regulation is not None
        if proof.slipped(self._regulation.felt or 0.0, measured):
            return self._ended(Outcome.SLIPPED, measured)
        if self._proven <= DURATION:
            return None
        enough = (proof.force or 0.0) >= self.held.least
        outcome = Outcome.HELD if enough else Outcome.FORCE_NOT_REACHED
        return self._ended(outcome, measured)

    def _lost(self, measured: Measurement, dt: float) -> bool:
        """Whether the force sensor feels nothing any more."""
        self._force.update(measured, dt)
        missing = self._force.measured and not self._force.touching
        self._missing = self._missing + 1 if missing else 0
        return self._missing >= LOST_SAMPLES

    def _over_limit(self, measured: Measurement) -> bool:
        force = measured.grip.value
        return (
            force is not None and force > self.held.profile.damage_force / TRIP_MARGIN
        )

    def _ended(self, outcome: Outcome, measured: Measurement) -> Ending:
        return kept(
            self.held,
            outcome,
            measured,
            self._chain,
            current=self.ramp.current,
            duration=self._elapsed,
        )
