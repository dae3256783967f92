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
from gripperd.model.parameter import amplitude
from gripperd.model.track import Array, Track

SOON = 10.0
"""Time in which a leaking line sinks to what the regulator's flow can keep. [s]"""


@dataclass(frozen=True, slots=True)
class Leak(InValve):
    r"""The pressure sinks while the command stands still.

    .. math:: p = p_0 \left(e^{-k t} - d\,(1 - e^{-t/10\,\mathrm s})\right)

    with t the time since the command last moved: the regulator fills up when it is
    told to move. The first term is a shut valve, the second a regulator that feeds the
    leak and droops.
    """

    name: ClassVar[str] = "leak"
    needs: ClassVar[frozenset[str]] = frozenset({"current", "pressure"})
    shows: ClassVar[str] = (
        "measured pressure sinks for as long as the current stands still, in proportion"
        " to the pressure"
    )
    confused_with: ClassVar[tuple[str, ...]] = ("creep", "supply_saturation")
    remedy: ClassVar[str] = "find the leak with soap water, fittings first"

    rate: float = amplitude(unit="per_s", scale=1e-3, low=0.0, high=1.0)
    """Pressure lost per pressure and time, valve shut. [1/s]"""
    early: float = amplitude(unit=None, scale=0.02, low=0.0, high=0.9)
    """Share of the pressure lost to the droop. [-]"""

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Pressure that is left. [Pa]."""
        left = np.exp(-self.rate * track.still)
        return value * (left + self.early * np.expm1(-track.still / SOON))
