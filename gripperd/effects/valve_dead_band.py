"""Dead band of the regulator: it does not follow small reversals.

References
----------
.. [1] ANSI/ISA-51.1-1979 (R1993), "Process Instrumentation Terminology": dead band.
.. [2] M. Brokate, J. Sprekels, "Hysteresis and Phase Transitions", Springer, 1996,
       section 2.3: play.
.. [3] M. A. A. S. Choudhury, N. F. Thornhill, S. L. Shah, "Modelling valve stiction",
       Control Eng. Pract. 13(5), 641-658, 2005: stick band and slip jump.
.. [4] K. J. Åström, T. Hägglund, "Advanced PID Control", ISA, 2006, chapter 3: on-off
       control with hysteresis.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from types import MappingProxyType
from typing import ClassVar

import numpy as np

from gripperd.model.kinds import InValve
from gripperd.model.memory import begin, play
from gripperd.model.parameter import amplitude, choice, shape
from gripperd.model.spool import slides, sticking, waking
from gripperd.model.track import Array, Track

NARROW = 5e3
"""Width up to which a band that wakes but late is a lag: common regulators settle
within 1 % of their span anyway. [Pa]"""


class Spool(StrEnum):
    """What a spool does once the command has left the band."""

    TRAILS = "trails"
    """It follows half a width behind."""
    STICKS = "sticks"
    """It slips to the command, and follows it until that turns round again."""
    WAKES = "wakes"
    """It goes to the command, all the way or nearly, and rests again."""


@dataclass(frozen=True, slots=True)
class ValveDeadBand(InValve):
    """Play of half the width on the pressure, or stiction of the whole.

    Two spools side by side, each with its play, leave the band one after the other. A
    regulator of two valves that open and shut wakes once the error is as large as the
    width, and lets both be shut once it is small [4]_: it need not turn round to rest.

    It begins where the pressure is, and at rest. Predictions of a steady pressure take
    the middle of the band.
    """

    name: ClassVar[str] = "valve_dead_band"
    needs: ClassVar[frozenset[str]] = frozenset({"current", "pressure"})
    shows: ClassVar[str] = (
        "a loop between current and pressure that is as wide however slowly it is run,"
        " and no answer to small reversals of the current"
    )
    confused_with: ClassVar[tuple[str, ...]] = ("valve_lag", "pressure_hysteresis")
    remedy: ClassVar[str] = (
        "approach each current from the same side, or use a finer regulator"
    )
    turns: ClassVar[str] = "current"
    idle: ClassVar[Mapping[str, tuple[str, ...]]] = MappingProxyType({
        Spool.TRAILS: ("short", "speed"), Spool.STICKS: ("spread", "short", "speed"),
        Spool.WAKES: ("spread",),
    })  # fmt: skip

    width: float = amplitude(unit="kPa", scale=15e3, low=0.0, high=100e3, decides=True)
    """Reversal of the command that is not followed. [Pa]"""
    spool: Spool = choice(Spool)  # noqa: RUF009  (declares)
    """What it does beyond."""
    spread: float = shape(unit=None, starts=(0.0, 0.4), low=0.0, high=1.0)
    """By how much two spools that trail side by side differ from their mean. [-]"""
    short: float = shape(unit=None, starts=(0.1,), low=0.01, high=0.9)
    """Share of the width that one that wakes leaves when it rests. [-]"""
    speed: float = shape(unit="kPa_per_s", starts=(200e3, 800e3), low=50e3, high=5e6)
    """At which it sets out, a width away; nearer it is slower in proportion. [Pa/s]

    So what has no band is not late. Slower than 50 kPa/s no regulator is that needs a
    fraction of a second to fill a muscle.
    """

    @property
    def becomes(self) -> str:
        """A lag, once the way to the command is long and the band hardly there."""
        return "valve_lag" if self.spool is Spool.WAKES and self.width < NARROW else ""

    def rest(self) -> Array:
        """A spool that has not begun."""
        return begin(3)

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Pressure behind the band. [Pa]."""
        if np.isnan(memory[0]) and np.isfinite(track.pressure[0]):
            memory[:] = self._begun(value, track.pressure)
        if self.spool is Spool.WAKES:
            law = (self.short, self.speed)
            return waking(value, track.step, self.width, law, memory)
        if self.spool is Spool.STICKS:
            return sticking(value, self.width, memory)
        shares = (1 + self.spread, 1 - self.spread)
        wide, narrow = (
            play(value, share * self.width / 2, memory[place : place + 1])
            for place, share in enumerate(shares)
        )
        return (wide + narrow) / 2

    def _begun(self, value: Array, pressure: Array) -> tuple[float, float, float]:
        """Memory of a spool at the first pressure that was measured."""
        if self.spool is Spool.TRAILS:
            return pressure[0], pressure[0], np.nan
        if self.spool is Spool.STICKS:
            return pressure[0], slides(value, pressure, self.width), np.nan
        # It rests, so within its band; the reading may be noise further out.
        away = np.clip(pressure[0] - value[0], -self.width, self.width)
        return value[0] + away, 0.0, np.nan
