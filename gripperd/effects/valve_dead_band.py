"""Dead band of the regulator: it does not follow small reversals.

References
----------
.. [1] ANSI/ISA-51.1-1979 (R1993), "Process Instrumentation Terminology": dead band.
.. [2] M. Brokate, J. Sprekels, "Hysteresis and Phase Transitions", Springer, 1996,
       section 2.3: play.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gripperd.model.kinds import InValve
from gripperd.model.memory import begin, play
from gripperd.model.parameter import amplitude
from gripperd.model.track import Array, Track


@dataclass(frozen=True, slots=True)
class ValveDeadBand(InValve):
    """Play of half the width on the pressure; it begins where the pressure is.

    Predictions of a steady pressure take the middle of the band.
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

    width: float = amplitude(unit="kPa", scale=5e3, low=0.0, high=100e3)
    """Reversal of the command that is not followed. [Pa]"""

    def rest(self) -> Array:
        """A play that has not begun."""
        return begin()

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Pressure behind the band. [Pa]."""
        if np.isnan(memory[0]) and np.isfinite(track.pressure[0]):
            memory[0] = track.pressure[0]
        return play(value, self.width / 2, memory)
