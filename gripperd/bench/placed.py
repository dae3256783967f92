"""An object that was put between the jaws, and what has become of it."""

from enum import StrEnum
from math import sqrt

from gripperd.bench.object import BenchObject
from gripperd.bench.settings import PlantSettings
from gripperd.units import STANDARD_GRAVITY

STEADY_RATE = 0.2
"""Relative change of the grip force per second that still counts as steady. [1/s]

Over the default delay the force changes by less than 5 %, which is well inside any
sensible slip margin, and it takes the lags of the rig about 0.3 s to get there.
"""

RESIDUAL_STIFFNESS = 0.2
"""Part of the stiffness that a cracked object keeps, an engineering estimate. [-]"""


class ObjectState(StrEnum):
    """Where the object is."""

    RESTING = "resting"
    """On its support, whether the jaws touch it or not."""
    HELD = "held"
    """Lifted; the jaws alone carry it."""
    SLIPPING = "slipping"
    """Lifted, and sliding down between the pads."""
    LOST = "lost"
    """Fallen; the jaws close on nothing."""


class PlacedObject:
    """One object from the moment it is placed: carried, slipping, broken, lost."""

    __slots__ = (
        "_friction",
        "_load",
        "_pull",
        "_settings",
        "_speed",
        "_steady",
        "_support",
        "cracked",
        "grip",
        "kind",
        "slid",
        "state",
        "stiffness",
    )

    def __init__(self, kind: BenchObject, settings: PlantSettings) -> None:
        self.kind = kind
        self.state = ObjectState.RESTING
        self.cracked = False
        """Whether the grip was ever harder than it can bear."""
        self.stiffness = kind.stiffness
        """What the jaws feel of it, 0 once it is lost. [N/m]"""
        self.grip = 0.0
        """Grip force per jaw at the last step. [N]"""
        self.slid = 0.0
        """How far it has slid down between the pads. [m]"""
        self._settings = settings
        self._load = STANDARD_GRAVITY + settings.lift_acceleration
        self._support = 2 * kind.friction / kind.mass
        self._friction, self._pull = 1.0, 0.0
        self._speed = 0.0
        self._steady = 0.0

    @property
    def width(self) -> float:
        """Distance between the pads where they touch a ball that has slid down. [m]."""
        reach = self.kind.diameter**2 - (2 * self.slid) ** 2
        return sqrt(max(reach, 0.0))

    def disturb(self, friction: float, pull: float) -> None:
        """Change what the pads hold it by.

        Parameters
        ----------
        friction
            Share of the friction that is left. [-]
        pull
            Downward force besides the weight. [N]
        """
        self._friction, self._pull = friction, pull

    @property
    def _excess(self) -> float:
        """Acceleration that the friction of both pads leaves, if above 0. [m/s²]."""
        load = self._load + self._pull / self.kind.mass
        return load - self._friction * self._support * self.grip

    @property
    def at_rest(self) -> bool:
        """Whether nothing more becomes of it as long as the grip stays as it is."""
        match self.state:
            case ObjectState.RESTING:
                return self.grip == 0.0
            case ObjectState.HELD:
                return self._excess <= 0.0
            case ObjectState.SLIPPING:
                return False
            case ObjectState.LOST:
                return True

    def step(self, grip: float, dt: float) -> None:
        """Let a grip force act for a time.

        Parameters
        ----------
        grip
            Grip force per jaw. [N]
        dt
            [s]
        """
        before, self.grip = self.grip, grip
        if grip > self.kind.damage_force and not self.cracked:
            self.cracked = True
            self.stiffness *= RESIDUAL_STIFFNESS
        if self.state is ObjectState.RESTING:
            self._await_lift(grip, abs(grip - before), dt)
        elif self.state is not ObjectState.LOST:
            self._slide(dt)

    def _await_lift(self, grip: float, change: float, dt: float) -> None:
        steady = grip > 0.0 and change <= STEADY_RATE * grip * dt
        self._steady = self._steady + dt if steady else 0.0
        if self._steady >= self._settings.lift_delay:
            self.state = ObjectState.HELD

    def _slide(self, dt: float) -> None:
        """Coulomb friction on two pads: it slides while ``2 μ N < m (g + a)``."""
        speed = self._speed + self._excess * dt
        if speed <= 0.0:
            self._speed = 0.0
            self.state = ObjectState.HELD
            return
        self._speed = speed
        self.slid += speed * dt
        self.state = ObjectState.SLIPPING
        if self.slid >= self.kind.diameter / 2:
            self.state = ObjectState.LOST
            self.stiffness = self.grip = 0.0
