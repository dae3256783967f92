"""The whole chain: valve current and object size to grip force per jaw, and back."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import isfinite
from typing import Self

from gripperd.errors import DomainError, InputError
from gripperd.model.constant import moved, moved_among
from gripperd.model.digest import digest
from gripperd.model.effect import Direction, Effect, acts_in_gripper, acts_in_valve
from gripperd.model.linkage import Linkage
from gripperd.model.loaded import LoadedLinkage
from gripperd.model.muscle import Muscle
from gripperd.model.outlet import Outlet
from gripperd.model.prediction import Prediction
from gripperd.model.pressed import RIGID, PressedObject
from gripperd.model.real import Real
from gripperd.model.regulator import Regulator
from gripperd.model.root import falling_root
from gripperd.model.static import StaticMuscle
from gripperd.model.uncertainty import combined
from gripperd.units import MILLI


@dataclass(frozen=True)
class Chain:
    """Regulator, muscle and linkage with their effects and their tolerances."""

    name: str
    static: StaticMuscle
    regulator: Regulator
    linkage: Linkage
    tolerances: Mapping[str, float] = field(default_factory=dict)
    """One sigma of each constant known only to within that, by path, such as
    ``muscle.diameter``. [SI]"""
    correlations: Mapping[tuple[str, str], float] = field(default_factory=dict)
    """Coefficient of correlation of two of these, by both paths; of others 0. [-]"""
    effects: tuple[Effect, ...] = ()
    """Those of valve, gripper and sensors; those of the muscle are in `static`.

    Predictions are of what settles, so memory and sensors do not count in them."""

    @cached_property
    def outlet(self) -> Regulator | Outlet:
        """Current to pressure and back, with the effects of the valve."""
        effects = tuple(filter(acts_in_valve, self.effects))
        return Outlet(self.regulator, effects) if effects else self.regulator

    @cached_property
    def _loaded(self) -> LoadedLinkage | None:
        effects = tuple(filter(acts_in_gripper, self.effects))
        return LoadedLinkage(self.linkage, effects) if effects else None

    @cached_property
    def digest(self) -> str:
        """What tells it from another of the same name."""
        return digest(self)

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
            return replace(self, regulator=moved(self.regulator, constant, by))
        if owner == "gripper":
            return replace(self, linkage=moved(self.linkage, constant, by))
        if owner == "muscle":
            muscle = moved(self.muscle, constant, by)
            return replace(self, static=replace(self.static, muscle=muscle))
        acting = {f"effects.{each.name}" for each in self.static.effects}
        if owner not in acting | {f"effects.{each.name}" for each in self.effects}:
            raise KeyError(path)
        inside = moved_among(self.static.effects, path, by)
        static = replace(self.static, effects=inside)
        return replace(self, static=static, effects=moved_among(self.effects, path, by))

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
        return self.grip_at(self.outlet.pressure(current), opening, direction)

    def grip_at(
        self,
        pressure: Real,
        opening: Real,
        direction: Real = Direction.CONTRACTING,
    ) -> Real:
        """Force of each jaw as :meth:`grip_force`, at a pressure in the muscle. [N]."""
        length = self.muscle.rest_length
        if self._loaded:
            return self._loaded.grip_force(
                lambda h: self.static.tension(pressure, h, direction),
                opening,
                direction,
                length,
            )
        contraction = self.linkage.contraction(opening, length)
        tension = self.static.tension(pressure, contraction, direction)
        return self.linkage.grip_force(tension, contraction, length)

    def current(
        self,
        grip_force: Real,
        opening: Real,
        direction: Real = Direction.CONTRACTING,
    ) -> Real:
        """Valve current for a force of each jaw at an opening. [A].

        In closed form, unless there are effects in the valve.

        Raises
        ------
        DomainError
            When neither muscle nor valve can do that.
        """
        outside = self.contraction(opening, grip_force, direction)
        force, contraction = self._pulling(outside, grip_force, direction)
        return self.outlet.current(self.static.pressure(force, contraction, direction))

    def _pulling(
        self, contraction: Real, grip_force: Real, direction: Real
    ) -> tuple[Real, Real]:
        """Pull of the muscle that holds a grip force, and its own contraction."""
        linkage, length = self.linkage, self.muscle.rest_length
        if not self._loaded:
            return linkage.muscle_force(grip_force, contraction, length), contraction
        spring = linkage.spring_force(contraction, length)
        pull = self._loaded.pull(grip_force, spring, direction)
        return pull, self._loaded.inside(contraction, pull)

    def contraction(
        self,
        opening: Real,
        grip_force: Real = 0.0,
        direction: Real = Direction.CONTRACTING,
    ) -> Real:
        """Contraction at which the jaws are this far apart under a grip force. [-]."""
        length = self.muscle.rest_length
        if self._loaded:
            return self._loaded.contraction(opening, grip_force, direction, length)
        return self.linkage.contraction(opening, length)

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
        contraction = float(self.contraction(opening, signed, direction))
        inside = float(self._pulling(contraction, signed, direction)[1])
        pressure = float(self.outlet.pressure(current))
        return Prediction(
            current=current,
            pressure=pressure,
            opening=opening,
            contraction=contraction,
            muscle_force=float(self.static.force(pressure, inside, direction)),
            spring_force=float(self.linkage.spring_force(contraction, length)),
            grip_force=grip,
            grip_std=self.std(current, pressed, direction),
            direction=direction,
            reaches=signed > 0,
            extrapolated=self.static.extrapolates(inside),
        )

    def std(
        self,
        current: float,
        pressed: PressedObject,
        direction: Direction = Direction.CONTRACTING,
    ) -> float:
        """Standard deviation of the grip force, from the tolerances. [N].

        To first order, each derivative by a central difference of one sigma.
        """
        changes = {}
        for path, pair in self._neighbours.items():
            low, high = (each.grip_on(current, pressed, direction) for each in pair)
            changes[path] = (high - low) / 2
        return combined(changes, self.correlations)

    @cached_property
    def _neighbours(self) -> "dict[str, tuple[Chain, Chain]]":
        """The chain with each constant one sigma down, and up."""
        return {
            path: (self.varied(path, -sigma), self.varied(path, sigma))
            for path, sigma in self.tolerances.items()
        }

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
