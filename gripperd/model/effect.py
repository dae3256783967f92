"""The port between the textbook and what it leaves out.

A :class:`MuscleEffect` adds a force to the ideal pull of eq. (4). The rubber of eq. (5)
and the friction of eq. (6) are effects like any other.
"""

from dataclasses import Field
from enum import IntEnum
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Protocol

from gripperd.model.real import Real

if TYPE_CHECKING:
    from gripperd.model.muscle import Muscle


class Direction(IntEnum):
    """Direction of travel; dry friction keeps its sign at rest, so it is state."""

    EXTENDING = -1
    CONTRACTING = 1


class MuscleState(NamedTuple):
    """What an effect may depend on."""

    pressure: Real
    """Gauge pressure in the bladder. [Pa]"""
    contraction: Real
    """Shortening relative to rest. [-]"""
    diameter_ratio: Real
    """Diameter relative to rest at this contraction. [-]"""
    direction: Real
    """+1 contracting, -1 extending, as :class:`Direction`."""


class MuscleEffect(Protocol):
    """One physical phenomenon that changes the pull of a muscle: a frozen dataclass."""

    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]
    name: ClassVar[str]

    def force(self, at: MuscleState, muscle: "Muscle") -> Real:
        """Force added to the ideal pull, positive when it helps to pull. [N]."""
        ...

    def kinks(
        self, contraction: Real, diameter_ratio: Real, muscle: "Muscle"
    ) -> tuple[Real, ...]:
        """Gauge pressures at which the slope of the force in p changes. [Pa].

        Between its kinks the force is affine in pressure, which makes the inverse
        problem closed.
        """
        ...
