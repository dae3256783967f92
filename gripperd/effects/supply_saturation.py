"""A supply that cannot deliver the top of the range, or sags.

References
----------
.. [1] ISO 10094-1:2010, "Pneumatic fluid power - Electro-pneumatic pressure control
       valves - Part 1": pressure regulation characteristics.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gripperd.model.kinds import InValve
from gripperd.model.parameter import amplitude, shape
from gripperd.model.real import Real, positive_part
from gripperd.model.track import Array, Track

WHOLE, PART = 0.3, 0.5
"""Place of a ceiling below which what is lost above it is a part of the line, and the
share of it up to which that is a part. [-]"""


@dataclass(frozen=True, slots=True)
class SupplySaturation(InValve):
    r"""Above a ceiling the pressure no longer follows.

    .. math:: p = p_0 - a\,[p_0 - c]_+ - b x m, \quad c = p_l + l (p_h - p_l) - m

    with x the place on the line from :math:`p_l` to :math:`p_h` and m what the supply
    has lost since its highest, where that is measured. The corner is rounded as
    :math:`w \ln(1 + e^{y/w})`, w the softness times the span, less what that is at the
    low end of the line.
    """

    name: ClassVar[str] = "supply_saturation"
    needs: ClassVar[frozenset[str]] = frozenset({"current", "pressure"})
    shows: ClassVar[str] = (
        "at high current the pressure stops to follow, or it sinks with the supply"
    )
    confused_with: ClassVar[tuple[str, ...]] = ("valve_nonlinearity", "valve_gain")
    remedy: ClassVar[str] = "raise the supply pressure, or keep below the limit"

    share: float = amplitude(unit=None, scale=0.5, low=0.0, high=1.0)
    """Part of what is asked above the ceiling that does not come; 1 clips. [-]"""
    sag: float = amplitude(unit=None, scale=0.1, low=0.0, high=1.0)
    """Pressure lost at the top of the line per loss of supply; what is won then is of
    another kind, of a poppet that the supply helps to close. [Pa/Pa]"""
    limit: float = shape(unit=None, starts=(0.9, 0.8, 0.7, 0.95), low=0.05, high=1.0)
    """Place of the ceiling on the line. [-]"""
    softness: float = shape(unit=None, starts=(0.0, 0.03), low=0.0, high=0.2)
    """How round the corner is, relative to the span. [-]"""

    @property
    def becomes(self) -> str:
        """A factor, once a part of nearly all of the line is lost at any supply."""
        is_factor = self.limit < WHOLE and self.share < PART and self.sag == 0
        return "valve_gain" if is_factor else ""

    def settled(self, pressure: Real, span: tuple[float, float]) -> Real:
        """Pressure under the ceiling with the supply at its highest. [Pa]."""
        return pressure - self.share * self._excess(pressure, span)

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Pressure that the supply of the moment allows. [Pa]."""
        low, high = track.span
        excess = self._excess(value + track.supply_drop, track.span)
        sunk = self.sag * track.supply_drop * (value - low) / (high - low)
        return value - self.share * excess - sunk

    def _excess(self, pressure: Real, span: tuple[float, float]) -> Real:
        low, high = span
        above = pressure - low - self.limit * (high - low)
        round_off = self.softness * (high - low)
        if not round_off:
            return positive_part(above)
        # What was not measured is not known here either.
        with np.errstate(invalid="ignore"):
            rounded: Real = round_off * np.logaddexp(0.0, above / round_off)
        empty = float(np.logaddexp(0.0, -self.limit / self.softness))
        return rounded - round_off * empty
