"""Halts: where a sweep that travels is held, while its pressure goes on.

What rubs in a muscle that is held may turn round with its pressure, as it may in a
sweep that is held from its beginning to its end.
"""

import numpy as np

from gripperd.diagnose.readings.course import Course
from gripperd.diagnose.readings.travel import reversal
from gripperd.model.compiled import compiled
from gripperd.model.track import Array

GOES_ON = 0.1
"""Share of its highest over which the pressure of a halt goes, at least."""


def halts(course: Course) -> tuple[slice, ...]:
    """Stretches in which a sweep that travels is held while its pressure goes on.

    Parameters
    ----------
    course
        A sweep without a pause.
    """
    way, pressure = course.level("contraction"), course.level("pressure")
    if not course.direction.any():
        return ()
    least = reversal(course.smooth["contraction"].spread)
    swept = GOES_ON * float(np.max(np.abs(pressure)))
    starts = np.flatnonzero(compiled(_leaves)(way, least))
    ends = np.append(starts[1:], way.size)
    return tuple(
        slice(start, end)
        for start, end in zip(starts.tolist(), ends.tolist(), strict=True)
        if np.ptp(pressure[start:end]) > swept
    )


def _leaves(way: Array, least: float) -> Array:
    """Mark the samples with which a way leaves a range, and the first."""
    found = np.zeros_like(way)
    found[0] = 1.0
    low = high = way[0]
    for i in range(1, way.size):
        low, high = min(low, way[i]), max(high, way[i])
        if high - low > least:
            found[i] = 1.0
            low = high = way[i]
    return found
