"""Slow filling: the pressure follows the command late.

References
----------
.. [1] E. Richer, Y. Hurmuzlu, "A high performance pneumatic force actuator system",
       J. Dyn. Sys., Meas., Control 122(3), 416-425, 2000: filling and exhaust differ.
"""

from dataclasses import dataclass
from typing import ClassVar

from gripperd.model.kinds import InValve
from gripperd.model.memory import begin, lag
from gripperd.model.parameter import amplitude, shape
from gripperd.model.track import Array, Track


@dataclass(frozen=True, slots=True)
class ValveLag(InValve):
    r"""Two lags in a row, of muscle and tube, that fill and exhaust at their own pace.

    .. math:: p = p_0 + a (p_l - p_0), \quad \tau \dot p_m = p_0 - p_m, \quad
              k \tau \dot p_l = p_m - p_l

    A tube holds the pressure back for a while, as a dead time does.
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

    tube: float = shape(unit=None, starts=(0.0, 1.0), low=0.0, high=1.0)
    """Time constants of the second lag over those of the first. [-]"""

    def rest(self) -> Array:
        """Two lags that begin settled."""
        return begin(2)

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Pressure that has come so far. [Pa]."""
        late = value
        for place, time in enumerate((self.time, self.tube * self.time)):
            if time > 0:
                state = memory[place : place + 1]
                late = lag(late, track.step, time, time * self.exhaust, state)
        return value + self.share * (late - value)
