"""Slow filling: the pressure follows the command late.

References
----------
.. [1] E. Richer, Y. Hurmuzlu, "A high performance pneumatic force actuator system",
       J. Dyn. Sys., Meas., Control 122(3), 416-425, 2000: filling and exhaust differ,
       and a valve that is choked lets no more through, however far the pressure is off.
.. [2] ISO 6358-1:2013: near the pressure behind it, an orifice lets through what grows
       as the square root of the drop, and far from it what grows with the pressure
       before it.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gripperd.model.filling import Filling, filled
from gripperd.model.kinds import InValve
from gripperd.model.memory import KEPT, delay
from gripperd.model.parameter import amplitude, shape
from gripperd.model.track import Array, Track

FAR = 100e3
"""Distance from the command at which orifice, choke and regulator are compared. [Pa]"""
LEAST_LATE = 0.5
"""Share of the pressure that a slow filling holds up at least: in 13 recordings of five
rigs that nobody here had seen 0.75, and 1 of a measured one. [-]"""
SLOWEST = 3.0
"""Time constant from which what holds up less is no filling; those had 0.3 s at most.
[s]"""


@dataclass(frozen=True, slots=True)
class ValveLag(InValve):
    r"""A dead time, then a lag that fills and exhausts at its own pace.

    .. math:: p = p_0 + a (p_l - p_0), \quad
        \tau \dot p_l = \frac{e}{1 - s + s (1 - c) \sqrt{|e|} + s c |e|}, \quad
        e = p_0(t - T) - p_l \quad \text{in 100 kPa}

    The regulator's own gain, an orifice and a choke hold the air up one after another.
    What empties into the air goes by with the pressure that is left in it [2]_, by a
    share of its own: see :func:`gripperd.model.filling.filled`. A spool that breaks
    loose and a tube hold the pressure back before it moves.
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
    """Time constant of filling, 100 kPa away. [s]"""
    exhaust: float = shape(unit=None, starts=(1.0, 2.0), low=0.2, high=10.0)
    """Time constant of exhaust over that of filling, at 300 kPa. [-]"""
    dead_time: float = shape(unit="ms", starts=(0.0, 0.03), low=0.0, high=1.0)
    """Time before anything follows. [s]"""
    throttle: float = shape(unit=None, starts=(0.0,), low=0.0, high=0.99)
    """What orifice and choke hold up, 100 kPa away; the rest the regulator. [0..1]"""
    choked: float = shape(unit=None, starts=(0.5,), low=0.0, high=1.0)
    """The choke's share of that. [0..1]"""
    sonic: float = shape(unit=None, starts=(0.0, 1.0), low=0.0, high=1.0, switches=True)
    """Share of the exhaust that goes with the pressure in the muscle. [0..1]"""

    @property
    def is_misnamed(self) -> bool:
        """Most of the air is there, and something else goes on: a coil that warms."""
        return self.share < LEAST_LATE and self.time > SLOWEST

    def rest(self) -> Array:
        """A lag that begins settled, then the past of a delay; shape (2, 1 + KEPT)."""
        return np.full((2, 1 + KEPT), np.nan)

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Pressure that has come so far. [Pa]."""
        late = delay(value, track.time, self.dead_time, memory[:, 1:])
        own = 1 - self.throttle
        law = Filling(
            own * self.time,
            own * self.time * self.exhaust,
            orifice=self.throttle * (1 - self.choked) / own / FAR**0.5,
            choke=self.throttle * self.choked / own / FAR,
            sonic=self.sonic,
        )
        late = filled(late, track.step, law, memory[0, :1])
        return value + self.share * (late - value)
