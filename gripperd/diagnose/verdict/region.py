"""Regions of a recording, as others read them."""

from collections.abc import Mapping
from math import isfinite
from types import MappingProxyType

import numpy as np

from gripperd.diagnose.readings.columns import BY_QUANTITY, Column
from gripperd.diagnose.verdict.key import number

Region = Mapping[str, tuple[float, float]]
"""Lowest and highest of quantities, by their names. [SI]"""

PLACES = {"time": 0, "pressure": 0, "contraction": 3}
"""Decimal places for a person, in the unit of the file."""
CLOCK = 3
"""Decimal places of a time for a program: seconds since 1970 have ten before them."""
WAYS: Mapping[str, tuple[str, str]] = MappingProxyType(
    {
        "direction": ("extending", "contracting"),
        "pressure_direction": ("falling", "rising"),
    }
)
"""Words for a way by its sign, -1 or 1."""


def span(region: Region, name: str) -> str:
    """Write one end of a region to the other, ``-`` when it says nothing of it.

    >>> span({"pressure": (1e5, 4e5)}, "pressure"), span({}, "pressure")
    ('100 to 400', '-')
    """
    if name not in region:
        return "-"
    column = BY_QUANTITY[name]
    places = PLACES.get(name, 1)
    low, high = ((end - column.zero) / column.scale for end in region[name])
    # Adding 0 turns what would read as -0 into 0.
    ends = [f"{round(end, places) + 0.0:.{places}f}" for end in (low, high)]
    return " to ".join(dict.fromkeys(ends))


def way(region: Region) -> str:
    """Say which way alone it went in a region; nothing where it rested or went both.

    >>> way({"direction": (-1.0, -1.0)}), way({"direction": (-1.0, 1.0)})
    ('extending', '')
    """
    said = []
    for name, (down, up) in WAYS.items():
        low, high = region.get(name, (0.0, 0.0))
        if (low < 0) != (high > 0):
            said.append(down if low < 0 else up)
    return ", ".join(said)


def region_document(region: Region) -> dict[str, list[float | None]]:
    """Write a region in the units of the file, by the names of its columns."""
    found = {}
    for name, ends in region.items():
        column = BY_QUANTITY.get(name, Column(name, name))
        values = column.written(np.array(ends)).tolist()
        write = _clock if name == "time" else number
        found[column.name] = [write(value) for value in values]
    return found


def _clock(value: float) -> float | None:
    return round(value, CLOCK) if isfinite(value) else None
