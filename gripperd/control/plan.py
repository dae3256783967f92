"""What the model says about one grasp: the currents to aim at, the force to expect."""

from dataclasses import replace
from math import hypot, sqrt

from gripperd.control.command import GraspOrder
from gripperd.control.force import CONTACT_FORCE
from gripperd.control.profile import Mode
from gripperd.control.setpoint import within
from gripperd.errors import DomainError
from gripperd.model import Chain, Direction, PressedObject
from gripperd.model.effect import acts_in_valve

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
        kept = tuple(each for each in chain.effects if not acts_in_valve(each))
        self._line = replace(chain, effects=kept)
        """The same with the straight line of the regulator, which has no top."""
        self._pressed = order.profile.pressed

    def touch(self, size: float) -> None:
        """From now on the size is known. [m]."""
        self.size = size
        self._pressed = replace(self._pressed, diameter=size)

    @property
    def near(self) -> float:
        """Current at which free jaws stand just before the largest object. [A]."""
        profile, chain = self._order.profile, self._chain
        widest = profile.diameter + profile.larger + CLEARANCE
        opening = min(widest, chain.linkage.open_width)
        try:
            return within(chain.regulator, float(chain.current(0.0, opening)))
        except DomainError:
            # Never so near by the model, so there is no reason to hurry.
            return chain.regulator.current_low

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
        return self._step(force, force + 1.0, Direction.CONTRACTING)

    def reduction(self, force: float) -> float:
        """By how much to lower the current to get from a force to the safe side. [A].

        Relative to now, since valve or model must be off; and through the whole band
        of friction, or nothing would move.
        """
        profile = self._order.profile
        safe = min(profile.damage_force / profile.crush_margin, force)
        return -self._step(force, safe, Direction.EXTENDING)

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
        """Current for a grip force; the highest where no current gives it. [A]."""
        highest, pressed = self._chain.regulator.current_high, self._pressed
        opening = pressed.diameter - force / pressed.stiffness
        if float(self._chain.grip_force(highest, opening)) <= force:
            return highest
        return within(self._chain.regulator, self._chain.current_for(force, pressed))

    def _step(self, start: float, end: float, direction: Direction) -> float:
        """Change of current from a force while closing to one in a direction. [A]."""
        try:
            return self._between(self._chain, start, end, direction)
        except DomainError:
            # What is felt is more than the valve of the model can give.
            return self._between(self._line, start, end, direction)

    def _between(
        self, chain: Chain, start: float, end: float, direction: Direction
    ) -> float:
        after = chain.current_for(end, self._pressed, direction)
        return after - chain.current_for(start, self._pressed)
