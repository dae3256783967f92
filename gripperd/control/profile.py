"""How one kind of object wants to be held."""

from dataclasses import dataclass
from enum import StrEnum

from gripperd.model import PressedObject
from gripperd.units import STANDARD_GRAVITY


class Mode(StrEnum):
    """What a grasp aims at."""

    CURRENT = "current"
    """A fixed valve current, as in the paper: 10.7 mA for every object."""
    FORCE = "force"
    """A grip force, by the inverted model and corrected by the measured force."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Profile:
    """An object's size, weight and limits, and how to grasp it."""

    name: str
    version: int
    diameter: float
    """Size between the jaws. [m]"""
    smaller: float
    """How much smaller the object may be. [m]"""
    larger: float
    """How much larger the object may be. [m]"""
    mass: float
    """[kg]"""
    stiffness: float
    """Grip force per jaw for a metre of yielding. [N/m]"""
    pad_friction: float
    """Between jaw pads and object. [-]"""
    acceleration: float
    """Largest acceleration while it is carried, on top of gravity. [m/s²]"""
    damage_force: float
    """Grip force per jaw that bruises, cracks or crushes it. [N]"""
    source: str
    """Where the limits come from."""
    slip_margin: float
    """Least factor between grip force and slip limit to aim for. [-]"""
    crush_margin: float
    """Least factor between damage limit and grip force to aim for. [-]"""
    mode: Mode
    current: float
    """Target of mode `current`. [A]"""
    force: float
    """Target of mode `force`, per jaw. [N]"""
    approach: float
    """Rate of the valve current until just before contact. [A/s]"""
    ramp: float
    """Rate of the valve current from there on. [A/s]"""
    compensate: bool = False
    """Correct the force while the object is held, when it creeps."""
    most_correction: float = 0.1
    """Share of the pressure by which corrections may change it. [-]"""

    slip_closing: float | None = None
    """Closing of the jaws that counts as slip, if less than elsewhere. [m]"""
    force_drift: float | None = None
    """Share of the force that may drift, if less than elsewhere. [-]"""

    @property
    def slip_force(self) -> float:
        """Least grip force per jaw that carries the object on two pads. [N].

        Coulomb friction: ``2 μ N = m (g + a)``.
        """
        weight = self.mass * (STANDARD_GRAVITY + self.acceleration)
        return weight / (2 * self.pad_friction)

    @property
    def pressed(self) -> PressedObject:
        """The object as the model sees it."""
        return PressedObject(self.diameter, self.stiffness)
