"""The whole chain: valve current and object size to grip force per jaw, and back."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import hypot, isfinite
from typing import TYPE_CHECKING, Self, TypeVar

from gripperd.errors import DomainError, InputError
from gripperd.model.effect import Direction
from gripperd.model.linkage import Linkage
from gripperd.model.muscle import Muscle
from gripperd.model.real import Real, positive_part
from gripperd.model.regulator import Regulator
from gripperd.model.root import falling_root
from gripperd.model.static import StaticMuscle
from gripperd.units import MILLI

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

Part = TypeVar("Part", bound="DataclassInstance")

RIGID = float("inf")
"""Stiffness of an object that does not yield. [N/m]"""


@dataclass(frozen=True, slots=True)
class PressedObject:
    """What stands between the jaws."""

    diameter: float
    """Distance between the jaws at first contact. [m]"""
    stiffness: float = RIGID
    """Grip force per jaw for a metre of yielding. [N/m]"""


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


@dataclass(frozen=True)
class Chain:
    """Regulator, muscle with its effects, and linkage, with their tolerances."""

    name: str
    static: StaticMuscle
    regulator: Regulator
    linkage: Linkage
    tolerances: Mapping[str, float] = field(default_factory=dict)
    """One sigma of each constant known only to within that, by path, such as
    ``muscle.diameter``. [SI]"""

    @property
    def muscle(self) -> Muscle:
        """Constants of the muscle."""
        return self.static.muscle

    def varied(self, path: str, by: float) -> Self:
        """Build the same chain with one constant moved.

        Parameters
        ----------
        path
            Which one, as in `tolerances`.
        by
            How far. [SI]

        Raises
        ------
        KeyError
            There is no such part; a tolerance on it would count for nothing.
        """
        owner, _, constant = path.rpartition(".")
        if owner == "valve":
            return replace(self, regulator=_moved(self.regulator, constant, by))
        if owner == "gripper":
            return replace(self, linkage=_moved(self.linkage, constant, by))
        if owner == "muscle":
            muscle = _moved(self.muscle, constant, by)
            return replace(self, static=replace(self.static, muscle=muscle))
        if owner not in {f"effects.{effect.name}" for effect in self.static.effects}:
            raise KeyError(path)
        effects = tuple(
            _moved(effect, constant, by)
            if owner == f"effects.{effect.name}"
            else effect
            for effect in self.static.effects
        )
        return replace(self, static=replace(self.static, effects=effects))

    def grip_force(
        self,
        current: Real,
        opening: Real,
        direction: Real = Direction.CONTRACTING,
    ) -> Real:
        """Force of each jaw with the jaws held at an opening.

        Parameters
        ----------
        current
            Valve current. [A]
        opening
            Distance between the jaws. [m]
        direction
            Direction of travel, or of the last travel when at rest.

        Returns
        -------
        Signed force, below 0 where the spring holds the jaws off. [N]
        """
        length = self.muscle.rest_length
        contraction = self.linkage.contraction(opening, length)
        pressure = self.regulator.pressure(current)
        force = self.static.force(pressure, contraction, direction)
        tension = positive_part(force)
        return self.linkage.grip_force(tension, contraction, length)

    def current(
        self,
        grip_force: Real,
        opening: Real,
        direction: Real = Direction.CONTRACTING,
    ) -> Real:
        """Valve current for a force of each jaw at an opening, in closed form. [A]."""
        length = self.muscle.rest_length
        contraction = self.linkage.contraction(opening, length)
        force = self.linkage.muscle_force(grip_force, contraction, length)
        return self.regulator.current(
            self.static.pressure(force, contraction, direction)
        )

    def grip_on(
        self,
        current: float,
        pressed: PressedObject,
        direction: Direction = Direction.CONTRACTING,
    ) -> float:
        """Force at which an object that yields balances the jaws, signed. [N].

        The root of ``grip(d - N / k) - N``, which falls with N.

        Raises
        ------
        DomainError
            When the jaws meet before the object resists enough.
        """
        diameter, stiffness = pressed.diameter, pressed.stiffness
        rigid = float(self.grip_force(current, diameter, direction))
        if rigid <= 0 or stiffness == RIGID:
            return rigid

        def surplus(force: float) -> float:
            opening = diameter - force / stiffness
            return float(self.grip_force(current, opening, direction)) - force

        high = min(rigid, stiffness * diameter)
        if surplus(high) > 0:
            message = (
                f"an object of {diameter / MILLI:g} mm and {stiffness * MILLI:g} N/mm"
                f" is squeezed flat at {current / MILLI:g} mA"
            )
            raise DomainError(message, key="stiffness_N_per_mm")
        return falling_root(surplus, 0.0, high)

    def current_for(
        self,
        grip_force: float,
        pressed: PressedObject,
        direction: Direction = Direction.CONTRACTING,
    ) -> float:
        """Valve current that presses an object with a force of each jaw. [A]."""
        opening = pressed.diameter - grip_force / pressed.stiffness
        return float(self.current(grip_force, opening, direction))

    def predict(
        self,
        current: float,
        pressed: PressedObject,
        direction: Direction = Direction.CONTRACTING,
    ) -> Prediction:
        """Say how hard an object is held at a current, and how sure that is.

        Raises
        ------
        InputError
            When the current is no number.
        DomainError
            When the object does not fit between the jaws, or is squeezed flat.
        """
        self.check_fits(pressed.diameter)
        if not isfinite(current):
            message = f"a current of {current} mA is no number"
            raise InputError(message, key="current_mA")
        signed = self.grip_on(current, pressed, direction)
        grip = max(signed, 0.0)
        opening = pressed.diameter - grip / pressed.stiffness
        length = self.muscle.rest_length
        contraction = float(self.linkage.contraction(opening, length))
        pressure = float(self.regulator.pressure(current))
        return Prediction(
            current=current,
            pressure=pressure,
            opening=opening,
            contraction=contraction,
            muscle_force=float(self.static.force(pressure, contraction, direction)),
            spring_force=float(self.linkage.spring_force(contraction, length)),
            grip_force=grip,
            grip_std=self.std(current, pressed, direction),
            direction=direction,
            reaches=signed > 0,
            extrapolated=self.static.extrapolates(contraction),
        )

    def std(
        self,
        current: float,
        pressed: PressedObject,
        direction: Direction = Direction.CONTRACTING,
    ) -> float:
        r"""Standard deviation of the grip force, to first order.

        .. math:: \sigma_N^2 = \sum_i \left(\frac{\partial N}{\partial c_i}
                  \sigma_i\right)^2

        over the constants with a tolerance, taken as independent; each derivative by
        a central difference of one sigma (JCGM 100:2008, eq. (10)). [N]
        """
        return hypot(*self._changes(current, pressed, direction))

    def _changes(
        self, current: float, pressed: PressedObject, direction: Direction
    ) -> Iterator[float]:
        for less, more in self._neighbours:
            low = less.grip_on(current, pressed, direction)
            yield (more.grip_on(current, pressed, direction) - low) / 2

    @cached_property
    def _neighbours(self) -> "tuple[tuple[Chain, Chain], ...]":
        """The chain with each constant one sigma down, and up."""
        return tuple(
            (self.varied(path, -sigma), self.varied(path, sigma))
            for path, sigma in self.tolerances.items()
        )

    def check_fits(self, diameter: float) -> None:
        """Refuse an object that is wider than the open jaws.

        Raises
        ------
        DomainError
            With both sizes.
        """
        if not 0 < diameter <= self.linkage.open_width:
            message = (
                f"an object of {diameter / MILLI:g} mm does not fit between the jaws:"
                f" they open {self.linkage.open_width / MILLI:g} mm"
            )
            raise DomainError(message, key="diameter_mm")


def _moved(whole: Part, constant: str, by: float) -> Part:
    return replace(whole, **{constant: getattr(whole, constant) + by})
