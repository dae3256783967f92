"""Zero error of the regulator.

References
----------
.. [1] ISO 10094-1:2010, "Pneumatic fluid power - Electro-pneumatic pressure control
       valves - Part 1": characteristics of the control signal against pressure.
.. [2] Festo, "Proportional pressure regulator VPPM", 537985, p. 31: zero-point
       suppression.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from types import MappingProxyType
from typing import ClassVar

import numpy as np

from gripperd.model.kinds import InValve
from gripperd.model.parameter import amplitude, choice, shape
from gripperd.model.real import Real
from gripperd.model.track import Array, Track

ZERO = 0.01
"""Place on the line below which a regulator that suppresses its zero is asked for
nothing, 0 to 1; its command repeats to a tenth of that. [-]"""


class Zero(StrEnum):
    """What a regulator does when it is asked for nothing."""

    REGULATED = "regulated"
    """It keeps the pressure of its line, and so the offset."""
    SUPPRESSED = "suppressed"
    """It vents, whatever its line is [2]_."""


@dataclass(frozen=True, slots=True)
class ValveOffset(InValve):
    r"""The line of the regulator is shifted: :math:`p = p_0 + b`.

    All of it, or only what lies above the zero that the regulator suppresses; there
    and below, it vents and sucks nothing. A pilot that opens by and by brings the
    offset by :math:`b (k + (1 - k) (1 - e^{-p_0 / p_f}))`, see :attr:`fade` and
    :attr:`kept`.
    """

    name: ClassVar[str] = "valve_offset"
    needs: ClassVar[frozenset[str]] = frozenset({"current", "pressure"})
    shows: ClassVar[str] = (
        "measured pressure is off against the current by a constant, while the force"
        " fits the measured pressure"
    )
    idle: ClassVar[Mapping[str, tuple[str, ...]]] = MappingProxyType(
        {Zero.REGULATED: ("fade", "kept")}
    )
    confused_with: ClassVar[tuple[str, ...]] = (
        "pressure_sensor_bias", "ambient_pressure",
    )  # fmt: skip
    remedy: ClassVar[str] = "trim the zero of the regulator, or the valve's line"

    offset: float = amplitude(unit="kPa", scale=5e3, low=-100e3, high=100e3)
    """Pressure beyond the line. [Pa]"""
    fade: float = shape(
        unit="kPa", starts=(0.0, 10e3), low=0.0, high=30e3, switches=True
    )
    """Pressure over which it comes where the zero is suppressed; 0 for all at once."""
    kept: float = shape(unit=None, starts=(0.0, 0.5), low=0.0, high=0.9, switches=True)
    """Share of it that is there all the same where the zero is suppressed. [-]"""
    zero: Zero = choice(Zero)  # noqa: RUF009  (declares)
    """What it does when it is asked for nothing."""

    def settled(self, pressure: Real, span: tuple[float, float]) -> Real:
        """Shifted pressure. [Pa]."""
        return self._shifted(pressure, pressure, span)

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Shifted pressure of each moment, where something is asked for. [Pa]."""
        return np.asarray(self._shifted(value, track.command, track.span))

    def _shifted(self, pressure: Real, asked: Real, span: tuple[float, float]) -> Real:
        if self.zero is Zero.REGULATED:
            return pressure + self.offset
        low, high = span
        above: Real = np.subtract(asked, low)
        awake: Real = 1.0
        if self.fade > 0:
            awake = -np.expm1(-np.maximum(above, 0.0) / self.fade)
        elif self.offset > 0:
            awake = np.heaviside(above - ZERO * (high - low), 0.0)
        shifted = pressure + (self.kept + (1.0 - self.kept) * awake) * self.offset
        if self.offset < 0:
            shifted = np.maximum(shifted, np.minimum(pressure, low))
        return shifted
