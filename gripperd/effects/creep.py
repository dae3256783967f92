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

from gripperd.model.kinds import InMuscle
from gripperd.model.memory import begin, lag
from gripperd.model.parameter import amplitude, choice, shape
from gripperd.model.track import Array, Track

SPACING = 6.0
"""Ratio of neighbouring time constants. Three terms this far apart follow a
logarithmic law over two decades within 4 % of its rise. [-]"""

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


@dataclass(frozen=True, slots=True)
class Creep(InMuscle):
    r"""Part of the pull, of the pressure, or of what rubber takes, comes late.

    With a series of time constants:

    .. math:: F = F_0 - c \sum_{i=0}^{2} a_i (u - u_i), \quad
              \tau_i \dot u_i = u - u_i, \quad \tau_i = 6^i \tau, \quad
              u = p \left[A(0) + l (A(h) - A(0))\right] - 5 b F_s(h), \quad c = 1

    with the leverage l of the length on what creeps: 1 when the pull itself does, 0
    when it pulls as at rest length. Of what the stretch of the rubber takes of it by
    eq. (5), b has a share: 1/5 when that creeps as the pull does, more when it creeps
    more, below 0 when it relaxes. A bladder that passes the pressure on late has
    ``u = p`` and pulls at the length of now, ``c = A(h)``, so that a travel under a
    settled pressure calls nothing up. One that relaxes under its own stretch alone has
    ``u = 5 F_s(h)``. Once settled it adds nothing. A record that begins under a load
    goes on from a wait under it, which may have been long.
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
        dict.fromkeys((Creeping.PRESSURE, Creeping.RUBBER), ("leverage", "stretch"))
    )
    rests_on: ClassVar[Mapping[str, str]] = MappingProxyType(
        {Creeping.RUBBER: "rubber_elasticity"}
    )
    travelling: ClassVar[frozenset[str]] = frozenset({Creeping.PRESSURE})

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

    of: Creeping = choice(Creeping)  # noqa: RUF009  (declares)
    """What comes late."""

    def rest(self) -> Array:
        """Three lags that have not begun."""
        return begin(3)

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Take from the pull what has not come yet."""
        pull = self._load(track)
        beside = self.stretch if self.of is Creeping.PULL else 0.0
        load = pull - beside * _stretched(track) if beside else pull
        late = np.zeros_like(load)
        if np.isnan(memory).all() and load.size:
            left = self.fresh ** (SPACING ** (1 - np.arange(3.0)))
            memory[:] = load[0] - left * pull[0]
        for index, share in enumerate((self.fast, self.medium, self.slow)):
            if share:
                time = self.time * SPACING**index
                state = memory[index : index + 1]
                late += share * (load - lag(load, track.step, time, state))
        if self.of is Creeping.PRESSURE:
            late *= track.pull_area
        return value - late

    def _load(self, track: Track) -> Array:
        """What creeps goes after, but for the stretch beside. [N], or pressure [Pa]."""
        if self.of is Creeping.PRESSURE:
            return track.pressure
        if self.of is Creeping.RUBBER:
            return _stretched(track)
        rest = track.muscle.pull_area(0.0)
        area = rest + self.leverage * (track.pull_area - rest)
        return np.asarray(track.pressure * area)


def _stretched(track: Track) -> Array:
    """Force of the rubber by eq. (5), as large as the pull. [N]."""
    ratio = track.diameter_ratio
    return np.asarray(RUBBER * track.muscle.elastic_force(track.contraction, ratio))
