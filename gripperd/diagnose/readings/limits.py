"""Readings that no working sensor gives."""

from collections.abc import Iterator, Mapping, Sequence
from types import MappingProxyType

import numpy as np

from gripperd.diagnose.readings.columns import BY_QUANTITY
from gripperd.diagnose.readings.fault import Fault
from gripperd.diagnose.readings.recording import Run
from gripperd.protocol.live_zero import BROKEN_ABOVE, BROKEN_BELOW

VACUUM = -101_325.0
"""Gauge pressure of a vacuum under the standard atmosphere. [Pa]"""
HUGE = 1e12
"""No quantity comes near it in any unit. [SI]"""

LIMITS: Mapping[str, tuple[float, float]] = MappingProxyType(
    {
        "current": (BROKEN_BELOW, BROKEN_ABOVE),
        "pressure": (VACUUM, HUGE),
        "supply": (VACUUM, HUGE),
        "ambient": (30e3, 120e3),
        "temperature": (213.15, 423.15),
        "contraction": (-1.0, 1.0),
        "length": (0.0, HUGE),
        "object": (0.0, HUGE),
    }
)
"""Lowest and highest reading there can be, by quantity. [SI]

The air is as thin as that on the highest mountain and as dense as in a deep mine, and
rubber is brittle at -60 °C and charred at 150 °C.
"""


def beyond_limits(runs: Sequence[Run]) -> Iterator[Fault]:
    """Find what is not finite, or beyond what is physically or electrically there."""
    for index, run in enumerate(runs):
        for quantity, values in run.columns.items():
            low, high = LIMITS.get(quantity, (-HUGE, HUGE))
            column = BY_QUANTITY[quantity]
            infinite = np.isinf(values)
            yield Fault(index, quantity, infinite, "not a finite number")
            under = (values < low) & ~infinite
            yield Fault(index, quantity, under, f"under {column.shown(low)}")
            above = (values > high) & ~infinite
            yield Fault(index, quantity, above, f"above {column.shown(high)}")
