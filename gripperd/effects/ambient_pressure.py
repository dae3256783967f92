"""An absolute transducer and a changing weather.

References
----------
.. [1] ISO 2533:1975, "Standard Atmosphere": 101 325 Pa at sea level.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gripperd.model.effect import Signal
from gripperd.model.kinds import InSensor
from gripperd.model.parameter import amplitude
from gripperd.model.track import Array, Track

STANDARD_ATMOSPHERE = 101_325.0
"""Absolute pressure at sea level, exact by definition (ISO 2533). [Pa]"""


@dataclass(frozen=True, slots=True)
class AmbientPressure(InSensor):
    r"""The gauge pressure was formed with a fixed pressure of the air.

    .. math:: p_r = p + a (P_a - 101\,325\,\mathrm{Pa}) + z

    An absolute transducer less a constant has a = 1, and z is the standard atmosphere
    less that constant. Where the pressure of the air is not known it is taken as that.
    """

    name: ClassVar[str] = "ambient_pressure"
    needs: ClassVar[frozenset[str]] = frozenset({"pressure", "ambient"})
    shows: ClassVar[str] = (
        "measured pressure is off by a constant within a session, and from session to"
        " session by what the barometer moved"
    )
    confused_with: ClassVar[tuple[str, ...]] = (
        "pressure_sensor_bias", "valve_offset",
    )  # fmt: skip
    remedy: ClassVar[str] = (
        "take the barometer off each reading, or use a gauge transducer"
    )

    share: float = amplitude(unit=None, scale=1.0, low=-1.5, high=1.5)
    """Error of the reading per deviation of the air pressure. [Pa/Pa]"""
    zero: float = amplitude(unit="kPa", scale=1e3, low=-2e3, high=2e3)
    """Error of the reading in the standard atmosphere. [Pa]"""

    @property
    def signal(self) -> Signal:
        """The pressure."""
        return Signal.PRESSURE

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Reading of a pressure. [Pa]."""
        return value + self._error(track)

    def truth(self, reading: Array, track: Track) -> Array:
        """Pressure behind a reading. [Pa]."""
        return reading - self._error(track)

    def _error(self, track: Track) -> Array:
        above = np.nan_to_num(track.ambient - STANDARD_ATMOSPHERE)
        return self.share * above + self.zero
