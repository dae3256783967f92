"""How long a way has rested: what rubs may fade there, as a viscous wall gives in."""

from dataclasses import replace

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
LEAST_PRESSURE = 6e3
"""The same of a pressure; and what goes by less in a second is not quick. [Pa]"""


def with_rests(course: Course) -> Course:
    """Tell since when a sweep rests, and since when its pressure stands as well.

    It rests nowhere where a muscle follows its pressure: what it holds against tells
    the friction at rest.

    Parameters
    ----------
    course
        A sweep without a pause.
    """
    if not np.isfinite(course.level("contraction")).all() or is_free(course):
        return course
    rested = _halted(course, "contraction", LEAST, 0.0)
    still = _halted(course, "pressure", LEAST_PRESSURE, LEAST_PRESSURE)
    return replace(course, rested=rested, stood=np.minimum(rested, still))


def _halted(course: Course, name: str, least: float, slow: float) -> Array:
    speed, way = np.abs(course.rate(name)), course.level(name)
    quick = max(float(np.quantile(speed, QUICK)), slow)
    since = compiled(_since)(speed, way, (STOPS * quick, GOES * quick), least)
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
