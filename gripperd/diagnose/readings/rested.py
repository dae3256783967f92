"""How long a way has rested: what rubs may fade there, as a viscous wall gives in."""

import numpy as np
import numpy.typing as npt

from gripperd.diagnose.readings.course import Course
from gripperd.diagnose.readings.sticking import is_free
from gripperd.model.compiled import compiled
from gripperd.model.track import Array

QUICK = 0.98
"""Quantile that stands for the speed of a way: its corners may leap. [-]"""
STOPS, GOES = 0.05, 0.2
"""Shares of that speed below which it comes to rest, and above which it goes on. [-]"""
LEAST = 1.5e-3
"""Contraction that ends a rest, however slowly it was gone. [-]"""


def rested(course: Course) -> Array:
    """Time since a sweep came to rest; 0 while it travels. [s].

    And throughout where a muscle follows its pressure: what it holds against tells the
    friction at rest.

    Parameters
    ----------
    course
        A sweep without a pause.
    """
    speed, way = np.abs(course.rate("contraction")), course.level("contraction")
    if not np.isfinite(way).all() or is_free(course):
        return np.zeros_like(course.time)
    quick = float(np.quantile(speed, QUICK))
    since = compiled(_since)(speed, way, (STOPS * quick, GOES * quick), LEAST)
    return np.asarray(course.time - course.time[since])


def _since(
    speed: Array, way: Array, ends: tuple[float, float], least: float
) -> npt.NDArray[np.int64]:
    """Give the sample at which each came to rest, or itself."""
    stops, goes = ends
    found = np.arange(speed.size)
    start = -1
    for i in range(speed.size):
        if start >= 0 and (speed[i] > goes or abs(way[i] - way[start]) > least):
            start = -1
        if start < 0 and speed[i] <= stops:
            start = i
        if start >= 0:
            found[i] = start
    return found
