"""Zero error of the pressure transmitter.

References
----------
.. [1] JCGM 200:2012 (VIM), 4.20: instrumental bias.
"""

from dataclasses import dataclass
from typing import ClassVar

from gripperd.model.effect import Signal
from gripperd.model.kinds import InSensor
from gripperd.model.parameter import amplitude
from gripperd.model.track import Array, Track


@dataclass(frozen=True, slots=True)
class PressureSensorBias(InSensor):
    r"""Every reading is off by a constant: :math:`p_r = p + b`."""

    name: ClassVar[str] = "pressure_sensor_bias"
    needs: ClassVar[frozenset[str]] = frozenset({"pressure"})
    shows: ClassVar[str] = (
        "measured pressure is off against the current by a constant, and the force"
        " against the measured pressure by as much the other way"
    )
    confused_with: ClassVar[tuple[str, ...]] = (
        "valve_offset", "threshold_pressure", "ambient_pressure",
    )  # fmt: skip
    remedy: ClassVar[str] = "vent the muscle and set the zero of the transmitter"

    bias: float = amplitude(unit="kPa", scale=5e3, low=-100e3, high=100e3)
    """Reading minus truth. [Pa]"""

    @property
    def signal(self) -> Signal:
        """The pressure."""
        return Signal.PRESSURE

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Reading of a pressure. [Pa]."""
        return value + self.bias

    def truth(self, reading: Array, track: Track) -> Array:
        """Pressure behind a reading. [Pa]."""
        return reading - self.bias
