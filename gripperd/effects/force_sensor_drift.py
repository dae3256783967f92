"""Zero of the force sensor that drifts with the clock.

References
----------
.. [1] JCGM 200:2012 (VIM), 4.21: instrumental drift.
.. [2] K. Hoffmann, "An Introduction to Measurements using Strain Gages", HBM, 1989:
       zero that wanders while gage and amplifier warm up.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gripperd.model.effect import Signal
from gripperd.model.kinds import InSensor
from gripperd.model.parameter import amplitude, shape
from gripperd.model.track import Array, Track


@dataclass(frozen=True, slots=True)
class ForceSensorDrift(InSensor):
    r"""Every reading is off in proportion to the clock, or until the cell is warm.

    .. math:: F_r = F + r \frac{1 - e^{-k t}}{k}, \quad F_r = F + r t
        \text{ for } k = 0
    """

    name: ClassVar[str] = "force_sensor_drift"
    needs: ClassVar[frozenset[str]] = frozenset({"force"})
    shows: ClassVar[str] = (
        "the measured force drifts with the clock, steadily or ever slower, whatever"
        " the muscle does, also across the rests between runs"
    )
    confused_with: ClassVar[tuple[str, ...]] = (
        "creep", "fatigue", "force_sensor_bias",
    )  # fmt: skip
    remedy: ClassVar[str] = "let the amplifier warm up, and tare before each run"
    timed: ClassVar[bool] = True

    rate: float = amplitude(unit="N_per_s", scale=0.01, low=-10.0, high=10.0)
    """First growth of reading minus truth, 0 at the start of the recording. [N/s]"""
    settling: float = shape(unit="per_s", starts=(0.0, 1e-3), low=0.0, high=1e-2)
    """How fast it comes to rest, as a cell warms up: k. [1/s]"""

    @property
    def signal(self) -> Signal:
        """The pull."""
        return Signal.FORCE

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Reading of a pull. [N]."""
        return value + self._off(track.time)

    def truth(self, reading: Array, track: Track) -> Array:
        """Pull behind a reading. [N]."""
        return reading - self._off(track.time)

    def _off(self, time: Array) -> Array:
        if self.settling == 0:
            return self.rate * time
        return np.asarray(self.rate * -np.expm1(-self.settling * time) / self.settling)
