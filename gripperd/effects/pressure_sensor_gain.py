"""Span error of the pressure transmitter.

References
----------
.. [1] JCGM 200:2012 (VIM), 4.12: sensitivity of a measuring system.
"""

from dataclasses import dataclass
from typing import ClassVar

from gripperd.model.effect import Signal
from gripperd.model.kinds import InSensor
from gripperd.model.parameter import amplitude
from gripperd.model.track import Array, Track


@dataclass(frozen=True, slots=True)
class PressureSensorGain(InSensor):
    r"""Every reading is off in proportion: :math:`p_r = p (1 + e)`."""

    name: ClassVar[str] = "pressure_sensor_gain"
    needs: ClassVar[frozenset[str]] = frozenset({"pressure"})
    shows: ClassVar[str] = (
        "measured pressure is off against the current in proportion, and the force"
        " against the measured pressure by as much the other way"
    )
    confused_with: ClassVar[tuple[str, ...]] = ("valve_gain", "force_sensor_gain")
    remedy: ClassVar[str] = "compare the transmitter with a gauge at two pressures"

    error: float = amplitude(unit=None, scale=0.02, low=-0.5, high=0.5)
    """Reading relative to truth, less 1. [-]"""

    @property
    def signal(self) -> Signal:
        """The pressure."""
        return Signal.PRESSURE

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Reading of a pressure. [Pa]."""
        return value * (1 + self.error)

    def truth(self, reading: Array, track: Track) -> Array:
        """Pressure behind a reading. [Pa]."""
        return reading / (1 + self.error)
