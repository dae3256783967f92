"""What the model says about one grasp: the currents to aim at, the force to expect."""

from dataclasses import replace
from math import hypot, sqrt

from gripperd.control.command import GraspOrder
from gripperd.control.force import CONTACT_FORCE
from gripperd.control.profile import Mode
from gripperd.control.setpoint import within
from gripperd.errors import DomainError
from gripperd.model import Chain, Direction, PressedObject

CLEARANCE = 2e-3
"""How far before the largest allowed object the slow ramp begins. [m]"""


class Plan:
    """The model's side of a grasp; sharper once the object is touched.

    Parameters
    ----------
    order
        What to grasp, already found feasible.
    chain
        The model of the gripper.
    """

    def __init__(self, order: GraspOrder, chain: Chain) -> None:
        self.size: float | None = None
        """Size of the object, once it is touched. [m]"""
        self._order = order
        self._chain = chain
        self._pressed = order.profile.pressed

    def touch(self, size: float) -> None:
        """From now on the size is known. [m]."""
        self.size = size
        self._pressed = replace(self._pressed, diameter=size)

    @property
    def near(self) -> float:
        """Current at which free jaws stand just before the largest object. [A]."""
        profile, linkage = self._order.profile, self._chain.linkage
        widest = profile.diameter + profile.larger + CLEARANCE
        return float(self._chain.current(0.0, min(widest, linkage.open_width)))

    @property
    def goal(self) -> float:
        """Current that should give what was ordered. [A]."""
        if self._order.mode is Mode.CURRENT:
            return self._order.target
        return self._for(self._order.target)

    @property
    def closing_limit(self) -> float:
        """Current beyond which closing on nothing is not pursued. [A]."""
        if self._order.mode is Mode.CURRENT:
            return self._order.target
        try:
            closed = float(self._chain.current(CONTACT_FORCE, 0.0))
        except DomainError:
            # The muscle is spent before the jaws meet: any current may be needed.
            closed = self._chain.regulator.current_high
        return within(self._chain.regulator, max(closed, self.goal))

    @property
    def safest(self) -> float:
        """Current that a correction must not exceed, whatever is felt. [A]."""
        profile = self._order.profile
        try:
            return self._for(profile.damage_force / profile.crush_margin)
        except DomainError:
            # Soft and tough: nothing the valve can do squeezes it that hard.
            return self._chain.regulator.current_high

    def current_per_newton(self, force: float) -> float:
        """Change of current for a change of grip force, at the object. [A/N]."""
        more = self._chain.current_for(force + 1.0, self._pressed)
        return more - self._chain.current_for(force, self._pressed)

    def reduction(self, force: float) -> float:
        """By how much to lower the current to get from a force to the safe side. [A].

        Relative to now, since valve or model must be off; and through the whole band
        of friction, or nothing would move.
        """
        profile = self._order.profile
        safe = min(profile.damage_force / profile.crush_margin, force)
        eased = self._chain.current_for(safe, self._pressed, Direction.EXTENDING)
        return self._chain.current_for(force, self._pressed) - eased

    def expected(
        self, current: float, opening: float, *, eased: bool
    ) -> tuple[float, float]:
        """Grip force at what is measured, and its standard deviation. [N, N].

        Once the force was eased, the friction may have any value between those of
        both directions of travel.
        """
        closing = float(self._chain.grip_force(current, opening))
        std = self._chain.std(current, PressedObject(opening))
        if not eased:
            return max(closing, 0.0), std
        opened = float(self._chain.grip_force(current, opening, Direction.EXTENDING))
        middle, half = (closing + opened) / 2, (opened - closing) / 2
        return max(middle, 0.0), hypot(std, half / sqrt(3))

    def _for(self, force: float) -> float:
        current = self._chain.current_for(force, self._pressed)
        return within(self._chain.regulator, current)
