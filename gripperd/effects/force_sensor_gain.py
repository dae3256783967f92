"""Span error of the force sensor.

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
class ForceSensorGain(InSensor):
    r"""Every reading is off in proportion: :math:`F_r = F (1 + e)`."""

    name: ClassVar[str] = "force_sensor_gain"
    needs: ClassVar[frozenset[str]] = frozenset({"force"})
    shows: ClassVar[str] = (
        "the measured force is off in proportion to itself, at all pressures and"
        " contractions"
    )
    confused_with: ClassVar[tuple[str, ...]] = ("pressure_sensor_gain", "fatigue")
    remedy: ClassVar[str] = "load the force sensor with two known weights"

    error: float = amplitude(unit=None, scale=0.02, low=-0.5, high=0.5)
    """Reading relative to truth, less 1. [-]"""

    @property
    def signal(self) -> Signal:
        """The pull."""
        return Signal.FORCE

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Reading of a pull. [N]."""
        return value * (1 + self.error)

    def truth(self, reading: Array, track: Track) -> Array:
        """Pull behind a reading. [N]."""
        return reading / (1 + self.error)
