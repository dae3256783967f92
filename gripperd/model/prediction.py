"""What the chain says about a grasp."""

from dataclasses import dataclass

from gripperd.model.effect import Direction


@dataclass(frozen=True, slots=True, kw_only=True)
class Prediction:
    """Everything the chain says about one grasp at one current. SI values."""

    current: float
    pressure: float
    opening: float
    contraction: float
    muscle_force: float
    """Signed pull; below 0 the muscle is slack. [N]"""
    spring_force: float
    grip_force: float
    """Force of each jaw on the object, 0 when the jaws do not reach it. [N]"""
    grip_std: float
    """Standard deviation of the grip force from the tolerances. [N]"""
    direction: Direction
    reaches: bool
    """Whether the jaws press on the object at all."""
    extrapolated: bool
    """Whether the muscle works outside the range it is specified for."""
