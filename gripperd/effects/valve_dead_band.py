"""Dead band of the regulator: it does not follow small reversals.

References
----------
.. [1] ANSI/ISA-51.1-1979 (R1993), "Process Instrumentation Terminology": dead band.
.. [2] M. Brokate, J. Sprekels, "Hysteresis and Phase Transitions", Springer, 1996,
       section 2.3: play.
.. [3] M. A. A. S. Choudhury, N. F. Thornhill, S. L. Shah, "Modelling valve stiction",
       Control Eng. Pract. 13(5), 641-658, 2005: stick band and slip jump.
"""

from dataclasses import dataclass
from enum import StrEnum
from typing import ClassVar

import numpy as np

from gripperd.model.kinds import InValve
from gripperd.model.memory import begin, play
from gripperd.model.parameter import amplitude, choice
from gripperd.model.spool import slides, sticking
from gripperd.model.track import Array, Track


class Spool(StrEnum):
    """What a spool does once the command has left the band."""

    TRAILS = "trails"
    """It follows half a width behind."""
    STICKS = "sticks"
    """It slips to the command, and follows it until that turns round again."""


@dataclass(frozen=True, slots=True)
class ValveDeadBand(InValve):
    """Play of half the width on the pressure, or stiction of the whole.

    It begins where the pressure is. Predictions of a steady pressure take the middle of
    the band.
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

    width: float = amplitude(unit="kPa", scale=15e3, low=0.0, high=100e3)
    """Reversal of the command that is not followed. [Pa]"""
    spool: Spool = choice(Spool)  # noqa: RUF009  (declares)
    """What it does beyond."""

    def rest(self) -> Array:
        """A spool that has not begun."""
        return begin(3)

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Pressure behind the band. [Pa]."""
        sticks = self.spool is Spool.STICKS
        if np.isnan(memory[0]) and np.isfinite(track.pressure[0]):
            memory[0] = track.pressure[0]
            memory[1] = slides(value, track.pressure, self.width) if sticks else 0.0
        if sticks:
            return sticking(value, self.width, memory)
        return play(value, self.width / 2, memory)
