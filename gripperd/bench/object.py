"""What can be put between the jaws."""

from dataclasses import dataclass
from math import inf

from gripperd.errors import InputError
from gripperd.units import MILLI


@dataclass(frozen=True, slots=True, kw_only=True)
class BenchObject:
    """A round, elastic object.

    Raises
    ------
    InputError
        When a value is not above 0 and finite; the key carries the unit.
    """

    diameter: float
    """Distance between the jaws at first contact. [m]"""
    stiffness: float
    """Grip force per jaw for a metre of yielding. [N/m]"""
    mass: float
    """[kg]"""
    friction: float
    """Coefficient between jaw pads and object. [-]"""
    damage_force: float
    """Grip force per jaw that cracks or crushes it. [N]"""

    def __post_init__(self) -> None:
        for key, value in (
            ("diameter_mm", self.diameter / MILLI),
            ("stiffness_N_per_mm", self.stiffness * MILLI),
            ("mass_g", self.mass / MILLI),
            ("friction", self.friction),
            ("damage_force_N", self.damage_force),
        ):
            if not 0 < value < inf:
                message = f"{key} = {value:g}: must be above 0 and finite"
                raise InputError(message, key=key)
