"""What a fault makes the jaws do, from the fault to rest."""

from typing import Protocol

from gripperd.control.command import GraspOrder
from gripperd.control.dispatch import STOP_TIME
from gripperd.control.monitors.policy import Reaction
from gripperd.control.monitors.sight import Sight
from gripperd.control.plan import Plan
from gripperd.control.profile import Mode, Profile
from gripperd.control.release import Release
from gripperd.control.setpoint import LONGEST_STEP, Ramp, within
from gripperd.errors import DomainError
from gripperd.model import Chain
from gripperd.signals import Measurement

REDUCTION_RATE = 20e-3
"""As fast as a release: the part is being damaged. [A/s]"""
MOST_REDUCTIONS = 4
"""So often a force that is too high is eased; each takes away most of what is left."""


class Response(Protocol):
    """A reaction that is being carried out."""

    ramp: Ramp

    def step(self, measured: Measurement, dt: float) -> bool | None:
        """Advance by one period; no longer None when it is over."""
        ...

    def rest(self, measured: Measurement) -> None:
        """Let the jaws rest where they are."""
        ...


class Ease:
    """Goes to a current and waits until the pressure has followed."""

    def __init__(self, current: float, goal: float) -> None:
        self.ramp = Ramp(current)
        self._goal = goal
        self._dwell = 0.0

    def step(self, measured: Measurement, dt: float) -> bool | None:
        """Advance by one period; True once the jaws are at rest."""
        self.ramp.tick(dt)
        if not self.ramp.towards(self._goal, REDUCTION_RATE, dt):
            return None
        self._dwell += min(dt, LONGEST_STEP)
        return True if self._dwell > STOP_TIME else None

    def rest(self, measured: Measurement) -> None:
        """Stay at the present current, where the jaws are still safe."""
        self._goal = self.ramp.current


class Reduction:
    """Eases an object that is held too hard, until it is on the safe side.

    Valve or model must be off, so what was reached is measured and eased again.
    """

    def __init__(self, profile: Profile, chain: Chain, current: float) -> None:
        order = GraspOrder(
            profile=profile, mode=Mode.FORCE, target=profile.force, model=chain.name
        )
        self.ramp = Ramp(current)
        self._safe = profile.damage_force / profile.crush_margin
        self._profile = profile
        self._chain = chain
        self._plan = Plan(order, chain)
        self._steps = MOST_REDUCTIONS
        self._ease = Ease(current, current)

    def step(self, measured: Measurement, dt: float) -> bool | None:
        """Advance by one period; True once the force is safe, False if it stays."""
        if self._steps == MOST_REDUCTIONS:
            self._reduce(measured)
        ended = self._ease.step(measured, dt)
        self.ramp = self._ease.ramp
        if ended is None:
            return None
        force = measured.grip.value
        if force is None or force <= self._safe:
            return True
        if self._steps == 0:
            return False
        self._reduce(measured)
        return None

    def rest(self, measured: Measurement) -> None:
        """Stay at the present current."""
        self._ease.rest(measured)
        self._steps = 0

    def _reduce(self, measured: Measurement) -> None:
        self._steps -= 1
        force, opening = measured.grip.value, measured.opening.value
        current = self.ramp.current
        if force is None:
            return
        if opening is not None:
            self._plan.touch(opening + force / self._profile.stiffness)
        try:
            goal = current - self._plan.reduction(force)
        except DomainError:
            return
        regulator = self._chain.regulator
        self._ease = Ease(current, within(regulator, min(goal, current)))


def response(reaction: Reaction, current: float, sight: Sight) -> Response:
    """Begin a reaction at a current. [A]."""
    chain = sight.chain
    match reaction:
        case Reaction.REDUCE if sight.profile is not None:
            return Reduction(sight.profile, chain, current)
        case Reaction.CONTROLLED_RELEASE:
            return Release(chain, current)
        case Reaction.VENT:
            return Release(chain, chain.regulator.current_low)
        case _:
            return Ease(current, current)
