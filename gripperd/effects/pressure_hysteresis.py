"""Memory of pressure: at a fixed length the force lags the pressure.

References
----------
.. [1] M. Brokate, J. Sprekels, "Hysteresis and Phase Transitions", Springer, 1996,
       chapter 2: the Prandtl-Ishlinskii operator.
.. [2] I. D. Mayergoyz, "Mathematical Models of Hysteresis and Their Applications",
       2nd ed., Elsevier, 2003, chapter 1: Preisach's model.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import ClassVar, Self

import numpy as np

from gripperd.model.effect import MuscleState
from gripperd.model.kinds import InMuscle
from gripperd.model.muscle import Muscle
from gripperd.model.parameter import amplitude, choice, shape
from gripperd.model.prandtl import at_rest, begin_at, carried, reaches, settled
from gripperd.model.preisach import (
    BARE,
    CLOSEST,
    NARROWEST,
    PARAMETERS,
    Hysteron,
    Relays,
)
from gripperd.model.real import Real, positive_part
from gripperd.model.track import Array, Track

NARROW = 20e3
"""Least half width of relays: what switches at one pressure has narrower ones. [Pa]"""


@dataclass(frozen=True, slots=True)
class PressureHysteresis(InMuscle):
    r"""Springs over pressure that slip after a third, one, three radii [1]_; or relays.

    .. math:: F = -H(p) \left(\frac{A(h)}{A(0)}\right)^c

    with H of :func:`gripperd.model.prandtl.carried`: less pull while inflating, more
    while deflating. With ``c = 1`` part of the pressure is lost in the bladder before
    it pulls; with ``c = 0`` the loop is the same at every length. The loop of relays
    [2]_ closes at the ends of their way instead, and a curve without a loop may go with
    them, see :class:`gripperd.model.preisach.Relays`.
    """

    name: ClassVar[str] = "pressure_hysteresis"
    needs: ClassVar[frozenset[str]] = frozenset({"force", "pressure", "contraction"})
    shows: ClassVar[str] = (
        "a loop between measured pressure and force at a fixed length, the same at any"
        " speed"
    )
    confused_with: ClassVar[tuple[str, ...]] = (
        "valve_dead_band", "channel_delay", "creep", "series_compliance",
    )  # fmt: skip
    remedy: ClassVar[str] = "always reach a pressure from the same side"
    turns: ClassVar[str] = "pressure"
    one_sided: ClassVar[bool] = True
    idle: ClassVar[Mapping[str, tuple[str, ...]]] = MappingProxyType({
        Hysteron.STOP: PARAMETERS,
        Hysteron.RELAY: ("near", "middle", "far", "pressure"),
    })  # fmt: skip

    near: float = amplitude(unit="N", scale=10.0, low=0.0, high=300.0)
    """Carried at rest length by the spring that slips first. [N]"""
    middle: float = amplitude(unit="N", scale=10.0, low=0.0, high=300.0)
    """Carried there by the next. [N]"""
    far: float = amplitude(unit="N", scale=10.0, low=0.0, high=300.0)
    """Carried there by the one that slips last. [N]"""
    pressure: float = shape(unit="kPa", starts=(30e3, 10e3, 100e3), low=2e3, high=300e3)
    """Change of pressure until the middle spring slips. [Pa]"""
    leverage: float = shape(unit=None, starts=(0.0, 1.0), low=0.0, high=1.0)
    """How far the loop shrinks with the ideal pull, c. [-]"""

    begun: float = shape(unit=None, starts=(0.0,), low=-1.0, high=1.0)
    """Load of the springs where a record begins: 1 as a way there from no pressure
    loads them, -1 the other way. [-]"""
    kept: float = shape(unit=None, starts=(0.0,), low=0.0, high=1.0)
    """Share that a vented muscle keeps of what deflating it has loaded. [-]"""
    exercised: float = shape(unit=None, starts=(0.0,), low=0.0, high=1.0)
    """The same before the first inflation of the record: none of a muscle that is new,
    up to all of one that was inflated before. [-]"""

    hysteron: Hysteron = choice(Hysteron)  # noqa: RUF009  (declares)
    """What remembers."""
    relays: float = amplitude(unit="N", scale=10.0, low=-300.0, high=300.0)
    """Given at rest length by the relays with all of them up. [N]"""
    radius: float = shape(unit="kPa", starts=(50e3,), low=NARROW, high=80e3)
    """Half the width of the narrow ones; no muscle switches much wider ones. [Pa]"""
    width: float = shape(unit=None, starts=(0.5,), low=NARROWEST, high=CLOSEST)
    """The same in scales of their density: much less, and they lie far apart. [-]"""
    wide: float = shape(unit=None, starts=(0.5,), low=0.0, high=1.0)
    """Share of those three times as wide. [-]"""
    centre: float = shape(unit="kPa", starts=(150e3, 350e3), low=0.0, high=1e6)
    """Mean pressure at which relays switch. [Pa]"""
    curve: float = shape(unit=None, starts=(0.0, 1.0), low=0.0, high=1.0)
    """Share that is left of the curve they would follow without a loop. [-]"""

    @property
    def is_misnamed(self) -> bool:
        """Something snaps at one pressure: a fold of the bladder, a hose that kinks."""
        return self.hysteron is Hysteron.RELAY and self._relays.snaps(NARROW)

    @property
    def forgetful(self) -> Self:
        """Relays that fall back where they rose."""
        if self.hysteron is Hysteron.STOP:
            return self
        return replace(self, radius=BARE * self.radius, width=BARE * self.width)

    @property
    def affine(self) -> bool:
        """Only of springs: what is up of relays bends with pressure."""
        return self.hysteron is Hysteron.STOP or not self.relays

    def force(self, at: MuscleState, muscle: Muscle) -> Real:
        """After a way from no pressure or a long way back; contracting inflates."""
        lever = self._lever(at.contraction, muscle)
        if self.hysteron is Hysteron.STOP:
            springs = (self.near, self.middle, self.far)
            path = at.pressure, at.direction, self.pressure
            return -settled(*path, springs, self.kept) * lever
        up = self._relays.settled(at.pressure, at.direction)
        return self.relays * up * lever

    def kinks(
        self, contraction: Real, diameter_ratio: Real, muscle: Muscle
    ) -> tuple[Real, ...]:
        """Where a spring begins to carry, and where each slips. [Pa]."""
        slips = ((1 + self.kept) * reach for reach in reaches(self.pressure))
        return tuple(0.0 * contraction + at for at in (0.0, *slips))

    def rest(self) -> Array:
        """Three springs without load."""
        return at_rest()

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Take what the springs carry. [N]."""
        # A transmitter may read less than nothing; to be vented is no way up.
        load = self.begun if np.all(track.pressure[:1] > 0) else 0.0
        kept = self.kept if np.all(track.cycle[:1] >= 1) else self.exercised
        begin_at(track.pressure, self._reach, load, memory, kept)
        lever = self._lever(track.contraction, track.muscle)
        if self.hysteron is Hysteron.RELAY:
            up = self._relays.up(track.pressure, memory[1:])
            return value + self.relays * up * lever
        springs = (self.near, self.middle, self.far)
        return value - carried(track.pressure, self.pressure, springs, memory) * lever

    def _lever(self, contraction: Real, muscle: Muscle) -> Real:
        area = positive_part(muscle.pull_area(contraction))
        return (area / muscle.pull_area(0.0)) ** self.leverage

    @property
    def _reach(self) -> float:
        return self.pressure if self.hysteron is Hysteron.STOP else self.radius

    @property
    def _relays(self) -> Relays:
        return Relays(self.radius, self.width, self.wide, self.centre, self.curve)
