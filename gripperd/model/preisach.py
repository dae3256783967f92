"""Preisach's model of hysteresis: relays in parallel, each of its own two thresholds.

References
----------
.. [1] I. D. Mayergoyz, "Mathematical Models of Hysteresis and Their Applications",
       2nd ed., Elsevier, 2003, chapter 1.
.. [2] M. Brokate, J. Sprekels, "Hysteresis and Phase Transitions", Springer, 1996,
       section 2.4: a relay is up where the play of half its width is above its middle,
       so that relays of one width are a function of one play.
"""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from gripperd.model.compiled import compiled
from gripperd.model.prandtl import SPREAD
from gripperd.model.real import Real
from gripperd.model.track import Array

NARROWEST = 0.25
"""Least half width of relays in scales of their density: up and down are 12 % apart
there, of all. Closer together they are a curve, with hardly a loop. [-]"""
CLOSEST = 1.0
"""The most of the same: all of them switch within about their own width. [-]"""
BARE = 1e-3
"""Share of their width of which relays have hardly a loop left. [-]"""
HELD = 0.01
"""Share of a limit within which a number is held by it. [-]"""
PARAMETERS = ("relays", "radius", "width", "wide", "centre", "curve")
"""Names of those of an effect that relays alone have."""


class Hysteron(StrEnum):
    """What a hysteresis is made of."""

    STOP = "stop"
    """Springs that stick, then slip: a loop as wide at the ends of a long way."""
    RELAY = "relay"
    """Switches that fall back later: a loop that closes at the ends of their way."""


@dataclass(frozen=True, slots=True)
class Relays:
    """Two groups of relays, one three times as wide; middles of a logistic density."""

    radius: float
    """Half the width of the narrow ones, as the signal."""
    width: float
    """The same in scales of the density; 1.8 of them are a standard deviation. [-]"""
    wide: float
    """Share of the wide ones. [0..1]"""
    centre: float
    """Mean of the middles, as the signal."""
    curve: float
    """Share that is left of the curve they would follow without a loop, from where the
    signal is 0: none for their memory alone. [0..1]"""

    def snaps(self, narrowest: float) -> bool:
        """Whether they would be narrower and closer yet, if they might: one switch.

        What they stand for lets go at one place and catches at another, as a fold of a
        bladder that snaps or a cable that is caught; no bank of relays is so.
        """
        return self.is_narrow(narrowest) and self.width >= (1 - HELD) * CLOSEST

    def is_narrow(self, narrowest: float) -> bool:
        """Whether they would be narrower yet, if they might."""
        return self.radius <= (1 + HELD) * narrowest

    def up(self, signal: Array, memory: Array) -> Array:
        """Share that is up along a path, however fast it is run, less the curve. [-].

        Parameters
        ----------
        signal
            The path, shape ``(n,)``.
        memory
            Where the plays of the two radii are, shape ``(2,)``; it is moved on.
        """
        law = (self.width, self.wide, self.centre, self.curve)
        return compiled(_up)(signal, self.radius, law, memory)

    def settled(self, signal: Real, way: Real) -> Real:
        """Share that is up after a long way up (1) or down (-1), less the curve."""
        return self._after(signal, way) - self._lost(signal)

    def _lost(self, signal: Real) -> Real:
        kept = self.curve * self._middle(0.0)
        if self.curve == 1:
            return kept
        return kept + (1 - self.curve) * self._middle(signal)

    def _middle(self, signal: Real) -> Real:
        return 0.5 * (self._after(signal, 1.0) + self._after(signal, -1.0))

    def _after(self, signal: Real, way: Real) -> Real:
        behind = way * self.radius
        return self._share(signal - behind, signal - SPREAD * behind)

    def _share(self, narrow: Real, wide: Real) -> Real:
        return (1 - self.wide) * self._below(narrow) + self.wide * self._below(wide)

    def _below(self, middle: Real) -> Real:
        distance = self.width * (middle - self.centre) / self.radius
        return 0.5 * (1 + np.tanh(0.5 * distance))


def _up(
    signal: Array,
    radius: float,
    law: tuple[float, float, float, float],
    memory: Array,
) -> Array:
    """As :meth:`Relays.up`; in short sweeps six times as fast as whole arrays."""
    width, wide, centre, curve = law
    steep = 0.5 * width / radius
    out = np.zeros_like(signal)
    for group, (share, reach) in enumerate(
        ((1 - wide, radius), (wide, SPREAD * radius))
    ):
        last = memory[group]
        up, down = np.tanh(steep * (-reach - centre)), np.tanh(steep * (reach - centre))
        kept = 0.5 * curve * (up + down)
        for index in range(signal.size):
            goal = signal[index]
            if np.isnan(last):
                last = goal
            last = min(max(last, goal - reach), goal + reach)
            lost = kept
            if curve < 1:
                up = np.tanh(steep * (goal - reach - centre))
                down = np.tanh(steep * (goal + reach - centre))
                lost += 0.5 * (1 - curve) * (up + down)
            out[index] += 0.5 * share * (np.tanh(steep * (last - centre)) - lost)
        memory[group] = last
    return out
