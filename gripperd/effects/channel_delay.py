"""One channel is sampled late.

References
----------
.. [1] L. Ljung, "System Identification: Theory for the User", 2nd ed., Prentice Hall,
       1999: delays between channels.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gripperd.model.effect import Signal
from gripperd.model.kinds import InSensor
from gripperd.model.memory import KEPT, delay
from gripperd.model.parameter import amplitude, choice
from gripperd.model.track import Array, Track


@dataclass(frozen=True, slots=True)
class ChannelDelay(InSensor):
    r"""A reading is what was some time ago: :math:`y_r(t) = y(t - T)`.

    Between samples on a straight line; before the first sample, the first value.
    """

    name: ClassVar[str] = "channel_delay"
    needs: ClassVar[frozenset[str]] = frozenset({"time"})
    shows: ClassVar[str] = (
        "loops between two channels that grow with the speed of the sweep and vanish"
        " when all stands still"
    )
    confused_with: ClassVar[tuple[str, ...]] = (
        "viscous_friction", "valve_lag", "linkage_backlash",
    )  # fmt: skip
    remedy: ClassVar[str] = "sample all channels at once, or shift this one in time"
    timed: ClassVar[bool] = True

    delay: float = amplitude(unit="ms", scale=0.05, low=0.0, high=1.0)
    """Age of a reading. [s]"""
    channel: Signal = choice(Signal)  # noqa: RUF009  (declares)
    """Which one is late."""

    @property
    def signal(self) -> Signal:
        """The late one."""
        return self.channel

    def rest(self) -> Array:
        """Times and values of the past, none yet; shape ``(2, KEPT)``."""
        return np.full((2, KEPT), np.nan)

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Late reading. [SI]."""
        return delay(value, track.time, self.delay, memory)

    def truth(self, reading: Array, track: Track) -> Array:
        """What was there at the time of each sample; at the end, the last. [SI]."""
        return np.interp(track.time + self.delay, track.time, reading)
