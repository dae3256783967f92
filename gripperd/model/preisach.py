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

from gripperd.model.memory import play
from gripperd.model.prandtl import SPREAD
from gripperd.model.real import Real
from gripperd.model.track import Array


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
    centre: float
    """Mean of the middles, as the signal."""
    spread: float
    """Scale of their density; 1.8 of it are a standard deviation. As the signal."""
    level: float
    """Share of the relays that is up where they take no force. [0..1]"""

    def taken(self, signal: Array, forces: tuple[float, float], memory: Array) -> Array:
        """Force that relays take along a path, however fast it is run. [N].

        Parameters
        ----------
        signal
            The path, shape ``(n,)``.
        forces
            What the narrow ones take with all of them up, and the wide ones. [N]
        memory
            Where the plays of the two radii are, shape ``(2,)``; it is moved on.
        """
        narrow = play(signal, self.radius, memory[:1])
        wide = play(signal, SPREAD * self.radius, memory[1:])
        return np.asarray(self._sum(forces, narrow, wide))

    def settled(self, signal: Real, way: Real, forces: tuple[float, float]) -> Real:
        """Force after a long way up (1) or down (-1). [N]."""
        behind = way * self.radius
        return self._sum(forces, signal - behind, signal - SPREAD * behind)

    def _sum(self, forces: tuple[float, float], narrow: Real, wide: Real) -> Real:
        return forces[0] * self._up(narrow) + forces[1] * self._up(wide)

    def _up(self, middle: Real) -> Real:
        distance = (middle - self.centre) / self.spread
        return 0.5 * (1 + np.tanh(0.5 * distance)) - self.level
