"""Air lost between regulator and muscle.

References
----------
.. [1] ISO 10094-1:2010, "Pneumatic fluid power - Electro-pneumatic pressure control
       valves - Part 1": leakage.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gripperd.model.kinds import InValve
from gripperd.model.memory import leaked
from gripperd.model.parameter import amplitude, shape
from gripperd.model.track import Array, Track

SOON = 10.0
"""Time in which a leaking line sinks to what the regulator's flow can keep. [s]"""


@dataclass(frozen=True, slots=True)
class Leak(InValve):
    r"""The pressure sinks while the command stands still.

    .. math:: p = p_0 - l - d\,p_0\,(1 - e^{-t/10\,\mathrm s})

    with l what a shut valve has lost, ``dl/dt = k (p_0 - l)`` while the command stands
    still and ``dl/dt = -l / r`` while it moves, and t the time since it last moved:
    told to move, the regulator fills up. So does one that is taken to keep the pressure
    while it is lost elsewhere. The last term is a regulator that feeds the leak and
    droops.
    """

    name: ClassVar[str] = "leak"
    needs: ClassVar[frozenset[str]] = frozenset({"current", "pressure"})
    shows: ClassVar[str] = (
        "measured pressure sinks for as long as the current stands still, in proportion"
        " to the pressure"
    )
    confused_with: ClassVar[tuple[str, ...]] = ("creep", "supply_saturation")
    remedy: ClassVar[str] = "find the leak with soap water, fittings first"
    timed: ClassVar[bool] = True

    rate: float = amplitude(unit="per_s", scale=1e-3, low=0.0, high=1.0)
    """Pressure lost per pressure and time, valve shut. [1/s]"""
    early: float = amplitude(unit=None, scale=0.02, low=0.0, high=0.9)
    """Share of the pressure lost to the droop. [-]"""
    refill: float = shape(unit="s", starts=(0.05, 2.0), low=0.005, high=30.0)
    """Time in which a regulator told to move fills up what was lost. [s]"""

    def rest(self) -> Array:
        """Nothing lost."""
        return np.zeros(1)

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Pressure that is left. [Pa]."""
        law = (self.rate, self.refill)
        lost = leaked(value, track.step, track.waiting, law, memory)
        return value - lost + value * self.early * np.expm1(-track.still / SOON)
