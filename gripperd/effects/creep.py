"""Creep of the rubber: the force goes on changing after a step.

References
----------
.. [1] J. D. Ferry, "Viscoelastic Properties of Polymers", 3rd ed., Wiley, 1980,
       chapter 1: generalised Maxwell element, a series of exponentials (Prony series).
"""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from types import MappingProxyType
from typing import ClassVar

import numpy as np

from gripperd.model.effect import MuscleState
from gripperd.model.kinds import InMuscle
from gripperd.model.memory import begin
from gripperd.model.muscle import Muscle
from gripperd.model.parameter import amplitude, choice, shape
from gripperd.model.prony import followed
from gripperd.model.real import Real
from gripperd.model.track import Array, Track

SPACING = 6.0
"""Ratio of neighbouring time constants. Three terms this far apart follow a
logarithmic law over two decades within 4 % of its rise. [-]"""
WAITS = SPACING ** (1 - np.arange(3.0))
"""A term has still to come what the middle one has, to this power, if both waited as
long. [-]"""

RUBBER = 5.0
"""Times the force of eq. (5) of which the shares of a bladder are told: the reference
muscle pulls so many times harder at 4 bar, 7 % shorter than at rest. [-]"""


class Creeping(StrEnum):
    """What comes late."""

    PULL = "pull"
    """What the pressure makes of the braid."""
    PRESSURE = "pressure"
    """What the bladder passes on of the pressure: it pulls at the length of now."""
    RUBBER = "rubber"
    """What the stretched bladder pulls back with: it relaxes after a stroke."""


class Holding(StrEnum):
    """When the pull is as the rest of the model has it."""

    SETTLED = "settled"
    """Once all has come: the constants are those of a muscle that has rested."""
    AT_ONCE = "at_once"
    """Before anything has: from there the muscle gives in, or goes on to pull."""


@dataclass(frozen=True, slots=True)
class Creep(InMuscle):
    r"""Part of the pull, of the pressure, or of what rubber takes, comes late.

    With a series of time constants:

    .. math:: F = F_0 - c \sum_{i=0}^{2} a_i (s u - u_i), \quad
              \tau_i \dot u_i = u - u_i, \quad \tau_i = 6^i \tau, \quad
              u = p \left[A(0) + l (A(h) - A(0))\right] - 5 b F_s(h), \quad c = s = 1

    with the leverage l of the length on what creeps: 1 when the pull itself does, 0
    when it pulls as at rest length. Of what the stretch of the rubber takes of it by
    eq. (5), b has a share: 1/5 when that creeps as the pull does, more when it creeps
    more, below 0 when it relaxes. A bladder that passes the pressure on late has
    ``u = p`` and pulls at the length of now, ``c = A(h)``, so that a travel under a
    settled pressure calls nothing up. One that relaxes under its own stretch alone has
    ``u = 5 [(1 - e) F_s(h) + e k h]``, where k is the slope of eq. (5) at rest length:
    with e = 1 it is a spring over the length. Once settled it adds nothing. Where the
    rest of the model holds at once instead, ``s = 0``, it adds nothing to begin with. A
    record that begins under a load goes on from a wait under it, which may have been
    long.
    """

    name: ClassVar[str] = "creep"
    needs: ClassVar[frozenset[str]] = frozenset({"force", "pressure", "contraction"})
    shows: ClassVar[str] = (
        "after a step the force drifts one way for seconds to minutes, while pressure"
        " and length stand still"
    )
    confused_with: ClassVar[tuple[str, ...]] = (
        "valve_lag", "force_sensor_drift", "leak", "presliding_hysteresis",
    )  # fmt: skip
    one_sided: ClassVar[bool] = True
    remedy: ClassVar[str] = (
        "wait until the grip has settled before judging it, or press a little harder"
        " at first"
    )

    idle: ClassVar[Mapping[str, tuple[str, ...]]] = MappingProxyType(
        {
            Creeping.PULL: ("even",),
            Creeping.PRESSURE: ("leverage", "stretch", "even"),
            Creeping.RUBBER: ("leverage", "stretch"),
        }
    )
    rests_on: ClassVar[Mapping[str, str]] = MappingProxyType(
        {Creeping.RUBBER: "rubber_elasticity"}
    )
    travelling: ClassVar[frozenset[str]] = frozenset({Creeping.PRESSURE})
    unusual: ClassVar[frozenset[str]] = frozenset({Holding.AT_ONCE})

    fast: float = amplitude(unit=None, scale=0.02, low=-0.15, high=0.15)
    """Share of the load that is late by the shortest time constant. [-]"""
    medium: float = amplitude(unit=None, scale=0.02, low=-0.15, high=0.15)
    """Share that is late by the next. [-]"""
    slow: float = amplitude(unit=None, scale=0.02, low=-0.15, high=0.15)
    """Share that is late by the longest. [-]"""
    time: float = shape(unit="s", starts=(2.0, 0.7, 5.0), low=0.2, high=12.0)
    """Shortest time constant: rubber creeps from the first seconds on. [s]"""
    leverage: float = shape(unit=None, starts=(1.0, 0.0), low=-0.5, high=1.5)
    """How much of the loss of leverage with contraction the creep shares. [-]"""
    fresh: float = shape(unit=None, starts=(0.0, 0.7), low=0.0, high=1.0, switches=True)
    """Share that the middle term has still to come where a record begins under
    pressure: 1 as the pressure comes, ``exp(-t / 6 tau)`` after a wait, 0 where all has
    settled. The others have waited as long. [-]"""

    stretch: float = shape(unit=None, starts=(0.0,), low=-4.0, high=4.0)
    """How much of the stretch of the rubber creeps beside the pull, b. [-]"""
    even: float = shape(unit=None, starts=(0.0,), low=0.0, high=1.0)
    """How much of what relaxes goes with the length alone, e. [-]"""

    of: Creeping = choice(Creeping)  # noqa: RUF009  (declares)
    """What comes late."""
    holds: Holding = choice(Holding)  # noqa: RUF009  (declares)
    """When the pull is as the rest of the model has it."""

    def force(self, at: MuscleState, muscle: Muscle) -> Real:
        """Force once all has settled: none, or all that has come since. [N]."""
        if self.holds is Holding.SETTLED:
            return 0.0 * at.contraction
        area = muscle.pull_area(at.contraction)
        load = self._load(at, area, muscle) - self._beside(at, muscle)
        shares = self.fast + self.medium + self.slow
        return shares * load * (area if self.of is Creeping.PRESSURE else 1.0)

    def rest(self) -> Array:
        """Three lags that have not begun."""
        return begin(3)

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Take from the pull what has not come yet."""
        at, muscle = track.state, track.muscle
        pull = np.asarray(self._load(at, track.pull_area, muscle))
        load = np.asarray(pull - self._beside(at, muscle))
        if np.isnan(memory).all() and load.size:
            memory[:] = load[0] - self.fresh**WAITS * pull[0]
        shares = self.fast, self.medium, self.slow
        times = self.time, self.time * SPACING, self.time * SPACING**2
        ahead = sum(shares) * load if self.holds is Holding.SETTLED else 0.0
        late = ahead - followed(load, track.step, times, shares, memory)
        if self.of is Creeping.PRESSURE:
            late *= track.pull_area
        return value - late

    def _load(self, at: MuscleState, area: Real, muscle: Muscle) -> Real:
        """What creeps goes after, but for the stretch beside. [N], or pressure [Pa]."""
        if self.of is Creeping.PRESSURE:
            return at.pressure
        if self.of is Creeping.RUBBER:
            spring = RUBBER * muscle.elastic_stiffness * at.contraction
            return (1 - self.even) * _stretched(at, muscle) + self.even * spring
        rest = muscle.pull_area(0.0)
        return at.pressure * (rest + self.leverage * (area - rest))

    def _beside(self, at: MuscleState, muscle: Muscle) -> Real:
        """What the stretch of the rubber takes of that. [N]."""
        if self.of is not Creeping.PULL or self.stretch == 0:
            return 0.0
        return self.stretch * _stretched(at, muscle)


def _stretched(at: MuscleState, muscle: Muscle) -> Real:
    """Force of the rubber by eq. (5), as large as the pull. [N]."""
    return RUBBER * muscle.elastic_force(at.contraction, at.diameter_ratio)
