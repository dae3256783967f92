"""Zero error of the force sensor.

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
class ForceSensorBias(InSensor):
    r"""Every reading is off by a constant: :math:`F_r = F + b`."""

    name: ClassVar[str] = "force_sensor_bias"
    needs: ClassVar[frozenset[str]] = frozenset({"force"})
    shows: ClassVar[str] = (
        "the measured force is off by the same amount at all pressures, contractions"
        " and directions, with the muscle vented too"
    )
    confused_with: ClassVar[tuple[str, ...]] = (
        "coulomb_friction", "threshold_pressure", "force_sensor_drift",
    )  # fmt: skip
    remedy: ClassVar[str] = "unload the force sensor and tare it"

    bias: float = amplitude(unit="N", scale=5.0, low=-500.0, high=500.0)
    """Reading minus truth. [N]"""

    @property
    def signal(self) -> Signal:
        """The pull."""
        return Signal.FORCE

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Reading of a pull. [N]."""
        return value + self.bias

    def truth(self, reading: Array, track: Track) -> Array:
        """Pull behind a reading. [N]."""
        return reading - self.bias
