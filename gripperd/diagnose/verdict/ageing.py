"""Friction that ages: what lies still sticks, and is torn off by the way it goes.

References
----------
.. [1] J. H. Dieterich, "Modeling of rock friction: 1. Experimental results and
       constitutive equations", J. Geophysical Research 84(B5), 2161-2168, 1979.
.. [2] A. E. Filippov, J. Klafter, M. Urbakh, "Friction through dynamical formation and
       rupture of molecular bonds", Physical Review Letters 92, 135503, 2004.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gripperd.model.compiled import compiled
from gripperd.model.kinds import InMuscle
from gripperd.model.memory import begin
from gripperd.model.parameter import amplitude, shape
from gripperd.model.track import Array, Track

MOVES = 0.002
"""Rate of contraction that is told from rest: three quarters of what sticks are felt.
What is held lies anywhere between both ways while it rests. [1/s]"""


@dataclass(frozen=True, slots=True)
class Ageing(InMuscle):
    """Bonds that form in time, and break along the way [2]_.

    The share s that holds follows ds/dt = (1 - s)/time - s |rate|/distance: what
    Dieterich's age of a contact is [1]_, with a limit. A sweep begins well rested.
    """

    name: ClassVar[str] = "ageing"
    needs: ClassVar[frozenset[str]] = frozenset({"force", "contraction"})
    shows: ClassVar[str] = "the force peaks where a travel sets out after a rest"
    confused_with: ClassVar[tuple[str, ...]] = (
        "coulomb_friction", "presliding_hysteresis", "first_cycle",
    )  # fmt: skip
    remedy: ClassVar[str] = "set out again shortly before a grip"

    size: float = amplitude(unit="N", scale=10.0, low=0.0, high=500.0)
    """Against the travel, after a long rest. [N]"""
    distance: float = shape(unit=None, starts=(0.004, 0.012), low=0.002, high=0.03)
    """Way of the contraction over which it is torn off to a third. [-]"""
    time: float = shape(unit="s", starts=(1.0, 4.0), low=0.2, high=20.0)
    """Rest in which two thirds of it come back. [s]"""

    def rest(self) -> Array:
        """A share that has not begun."""
        return begin()

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Pull that is left. [N]."""
        laws = self.distance, self.time
        bonds = compiled(_bonds)(np.abs(track.rate), track.step, laws, memory)
        felt = np.tanh(np.abs(track.rate) / MOVES) * track.direction
        return np.asarray(value - self.size * bonds * felt)

    def told(self, _start: float) -> str:
        """Say what it does."""
        rest = (
            f"{self.size:.0f} N after a long rest, most of it after {self.time:.1f} s"
        )
        return f"sticks by {rest}, torn off within {self.distance:.1%} of contraction"


def _bonds(rate: Array, step: Array, laws: tuple[float, float], state: Array) -> Array:
    distance, time = laws
    out = np.empty_like(rate)
    held = 1.0 if np.isnan(state[0]) else state[0]
    for index in range(rate.size):
        # Exact for a rate that is constant between samples.
        changes = 1 / time + rate[index] / distance
        settled = 1 / (time * changes)
        held = settled + (held - settled) * np.exp(-changes * step[index])
        out[index] = held
    state[0] = held
    return out
