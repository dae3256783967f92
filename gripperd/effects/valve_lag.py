"""Slow filling: the pressure follows the command late.

References
----------
.. [1] E. Richer, Y. Hurmuzlu, "A high performance pneumatic force actuator system",
       J. Dyn. Sys., Meas., Control 122(3), 416-425, 2000: filling and exhaust differ,
       and a valve that is choked lets no more through, however far the pressure is off.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gripperd.model.kinds import InValve
from gripperd.model.memory import KEPT, delay, lag
from gripperd.model.parameter import amplitude, shape
from gripperd.model.track import Array, Track

CHOKED = 100e3
"""Distance of a pressure from its command to which the choke refers. [Pa]"""


@dataclass(frozen=True, slots=True)
class ValveLag(InValve):
    r"""A dead time, then a lag that fills and exhausts at its own pace.

    .. math:: p = p_0 + a (p_l - p_0), \quad
        \tau \dot p_l = \frac{e}{1 + c |e|}, \quad e = p_0(t - T) - p_l

    A spool that breaks loose and a tube hold the pressure back before it moves.
    """

    name: ClassVar[str] = "valve_lag"
    needs: ClassVar[frozenset[str]] = frozenset({"current", "pressure"})
    shows: ClassVar[str] = (
        "the pressure lags behind the command, the more the faster it changes"
    )
    confused_with: ClassVar[tuple[str, ...]] = ("valve_dead_band", "channel_delay")
    remedy: ClassVar[str] = "ramp the current more slowly, or feed the valve better"

    share: float = amplitude(unit=None, scale=1.0, low=0.0, high=1.5)
    """Part of the pressure that comes late; 1 for a plain lag. [-]"""
    time: float = shape(
        unit="s", starts=(0.5, 0.05, 0.15, 1.5, 5.0), low=0.005, high=60.0
    )
    """Time constant of filling. [s]"""
    exhaust: float = shape(unit=None, starts=(1.0, 2.0), low=0.2, high=5.0)
    """Time constant of exhaust over that of filling. [-]"""
    dead_time: float = shape(unit="ms", starts=(0.0, 0.03), low=0.0, high=1.0)
    """Time before anything follows. [s]"""
    choke: float = shape(unit=None, starts=(0.0,), low=0.0, high=50.0)
    """One over the distance at which the rate is halved; 0: plain lag. [1/(100 kPa)]"""

    def rest(self) -> Array:
        """A lag that begins settled, then the past of a delay; shape (2, 1 + KEPT)."""
        return np.full((2, 1 + KEPT), np.nan)

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Pressure that has come so far. [Pa]."""
        late = delay(value, track.time, self.dead_time, memory[:, 1:])
        exhaust = self.time * self.exhaust
        choke = self.choke / CHOKED
        late = lag(late, track.step, self.time, exhaust, memory[0, :1], choke)
        return value + self.share * (late - value)
