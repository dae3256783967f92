"""Rows of sweeps that ask the same of the rig, without another between."""

from collections.abc import Sequence
from math import inf

import numpy as np

from gripperd.diagnose.readings.recording import Run

REACH = {"contraction": 0.1}
"""Least full scale for the comparison of sweeps. [SI]"""


def rows(sweeps: Sequence[Run]) -> list[float]:
    """How often the same sweep was run before without another between; NaN outside.

    A row is three or more: a single repeat is a check of the rig, not a row.
    """
    places: list[int] = []
    for index, sweep in enumerate(sweeps):
        follows = index > 0 and alike(sweeps[index - 1], sweep)
        places.append(places[-1] + 1 if follows else 0)
    lengths = [1] * len(places)
    for index in range(len(places) - 1, -1, -1):
        last = index + 1 >= len(places) or places[index + 1] == 0
        lengths[index] = places[index] + 1 if last else lengths[index + 1]
    return [
        float(place) if length >= 3 else np.nan
        for place, length in zip(places, lengths, strict=True)
    ]


def alike(one: Run, other: Run) -> bool:
    """Whether two sweeps ask the same of the rig: same length, inputs within 3 %."""
    n, m = len(one), len(other)
    if abs(n - m) > 0.1 * max(n, m):
        return False
    command = "current" if one.has("current") or other.has("current") else "pressure"
    asked = [c for c in (command, "contraction") if one.has(c) or other.has(c)]
    if not asked or not all(one.has(c) and other.has(c) for c in asked):
        return False
    for name in asked:
        a, b = one.columns[name], other.columns[name]
        k = min(n, m)
        tops = [np.nanmax(np.abs(column)) for column in (a, b)]
        reach = max(*tops, REACH.get(name, 0.0))
        apart = np.abs(a[:k] - b[:k])
        known = apart[~np.isnan(apart)]
        gap = np.mean(known) if known.size else inf
        if not gap <= 0.03 * reach:
            return False
    return True
