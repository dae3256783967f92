"""4-20 mA loops: what a current says about the quantity, or about the loop."""

from dataclasses import dataclass
from math import isnan

from gripperd.signals import Reading
from gripperd.units import MILLI

BROKEN_BELOW = 3.6e-3
"""A transmitter signals failure below this (NAMUR NE 43). [A]"""
BROKEN_ABOVE = 21.0e-3
"""A transmitter signals failure above this (NAMUR NE 43). [A]"""


@dataclass(frozen=True, slots=True, kw_only=True)
class LoopScale:
    """Straight line between loop current and quantity."""

    value_low: float
    """Quantity at `current_low`. [SI]"""
    value_high: float
    """Quantity at `current_high`. [SI]"""
    current_low: float = 4e-3
    """The live zero. [A]"""
    current_high: float = 20e-3
    """[A]"""

    def reading(self, current: float) -> Reading:
        """Quantity that a current stands for, or why there is none.

        >>> gauge = LoopScale(current_low=0.004, current_high=0.020,
        ...                   value_low=0.0, value_high=600e3)
        >>> gauge.reading(0.012).value
        300000.0
        >>> gauge.reading(0.0).cause
        'the loop is broken: 0.000 mA is below 3.6 mA'
        """
        if not BROKEN_BELOW <= current <= BROKEN_ABOVE:
            return Reading.bad(_complaint(current))
        share = (current - self.current_low) / (self.current_high - self.current_low)
        return Reading(self.value_low + share * (self.value_high - self.value_low))

    def current(self, value: float) -> float:
        """Loop current of a quantity; beyond the span the line goes on. [A]."""
        share = (value - self.value_low) / (self.value_high - self.value_low)
        return self.current_low + share * (self.current_high - self.current_low)


def _complaint(current: float) -> str:
    if isnan(current):
        return "the loop is broken: its current is not a number"
    side, limit = ("below", BROKEN_BELOW)
    if current > BROKEN_ABOVE:
        side, limit = ("above", BROKEN_ABOVE)
    found = current / MILLI
    # A float register may hold more digits than anybody wants to read.
    shown = f"{found:.3f}" if abs(found) < 1e3 else f"{found:.3g}"
    return f"the loop is broken: {shown} mA is {side} {limit / MILLI:g} mA"
