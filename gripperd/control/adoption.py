"""Taking over what is held already: nothing moves, the grip has to prove itself."""

from gripperd.control.command import Outcome
from gripperd.control.ending import Ending
from gripperd.control.force import ForceSense
from gripperd.control.grasp import TRIP_MARGIN
from gripperd.control.held import Held
from gripperd.control.keeping import kept
from gripperd.control.profile import Profile
from gripperd.control.proof import DURATION, Proof
from gripperd.control.setpoint import Ramp
from gripperd.model import Chain
from gripperd.signals import Measurement


class Adoption:
    """From the first look to the verdict; the current stays as it was found.

    Parameters
    ----------
    profile
        Limits that what is held is to be held by.
    chain
        The model of the gripper.
    current
        Valve current that was found. [A]
    """

    def __init__(self, profile: Profile, chain: Chain, current: float) -> None:
        self.ramp = Ramp(current)
        self.held = Held(profile=profile, size=profile.diameter)
        self._chain = chain
        self._force = ForceSense()
        self._proof: Proof | None = None
        self._elapsed = 0.0

    def step(self, measured: Measurement, dt: float) -> Ending | None:
        """Advance by one period."""
        self._elapsed += dt
        self._force.update(measured, dt)
        force = measured.grip.value
        if force is not None:
            proof = self._proof = self._proof or Proof(force, measured.opening.value)
            proof.add(force)
            if proof.slipped(self._force.filtered or 0.0, measured):
                return self._ended(Outcome.SLIPPED, measured)
        if self._elapsed <= DURATION:
            return None
        return self._ended(self._verdict(measured), measured)

    def rest(self, measured: Measurement) -> None:
        """Stay; there is nothing to stop."""

    def _verdict(self, measured: Measurement) -> Outcome:
        profile, opening = self.held.profile, measured.opening.value
        force = self._proof.force if self._proof else None
        if force is None:
            return Outcome.UNKNOWN
        size = profile.diameter
        if opening is not None:
            size = opening + force / profile.stiffness
        self.held = Held(profile=profile, size=size)
        if size < profile.diameter - profile.smaller:
            return Outcome.TOO_SMALL
        if size > profile.diameter + profile.larger:
            return Outcome.TOO_LARGE
        if force > profile.damage_force / TRIP_MARGIN:
            return Outcome.CRUSH_LIMIT
        return Outcome.HELD if force >= self.held.least else Outcome.FORCE_NOT_REACHED

    def _ended(self, outcome: Outcome, measured: Measurement) -> Ending:
        return kept(
            self.held,
            outcome,
            measured,
            self._chain,
            current=self.ramp.current,
            duration=self._elapsed,
        )
