"""Samples in which a muscle sticks: which way its friction acts is not known.

Whatever holds a muscle that lies still, object, spring or weight, takes up what the
pressure changes until friction has turned round.
"""

from collections.abc import Iterable, Iterator
from itertools import pairwise
from math import ceil
from statistics import median
from typing import NamedTuple

import numpy as np
from scipy.ndimage import binary_dilation

from gripperd.diagnose.readings.course import Course
from gripperd.diagnose.readings.fault import Mask
from gripperd.diagnose.readings.grasp import PRESSED
from gripperd.diagnose.readings.travel import STUCK, reversal, travel
from gripperd.model.track import Array

BRIEF = 5
"""Samples of which a trend may miss the less beside a corner. [-]"""

STICKS = 0.1
"""Share of the highest pressure by which one turns before a free muscle follows: 0.5 of
5 bar near no load of a 10 mm muscle whose isotonic loop was measured. [-]"""

SAGGED = 0.005
"""Share of the highest pressure by which one goes back that changes the pull by as much
as its noise. [-]"""

SWINGS = 0.02
"""The same of what a regulator swings about a pressure it holds. [-]"""

SWEPT = 0.2
"""Share of it over which it goes, if it is more than what is left of an isobar. [-]"""

FOLLOWING = 0.6
"""Correlation with its pressure from which a contraction is taken to follow it all the
way: on four rigs 0.94 and more under a weight, 0.33 and less where a machine moves it
apart from the pressure, but 0.79 where one moves it in step. [-]"""

DRIVING = 0.1
"""Share of a way of pressure that lies in its last quarter, if it still goes on. [-]"""


def stuck(course: Course) -> Mask:
    """Samples in which jaws hold on and do not follow a pressure that has turned.

    The muscle goes by less than is measured, or sticks: until its contraction has
    followed, its friction lies anywhere between the two directions.
    """
    found = np.zeros(len(course), dtype=bool)
    grip, pressure = course.level("grip"), course.level("pressure")
    if not (np.isfinite(grip).any() and np.isfinite(pressure).all()):
        return found
    grip = np.nan_to_num(grip - np.nanmin(grip))
    holds = (grip > PRESSED * course.hush("grip")) & (grip > 0)
    least = STUCK * float(np.ptp(pressure))
    sign, way = travel(pressure, least), course.level("contraction")
    followed = _followed(course)
    ends = np.flatnonzero(np.diff(holds, prepend=False, append=False))
    for start, end in ends.reshape(-1, 2).tolist():
        for turn, after in _legs(sign, start, end):
            gone = sign[turn] * (way[turn:after] - way[turn])
            found[turn:after] = ~np.logical_or.accumulate(gone > followed)
    return binary_dilation(found, iterations=2)


def late(course: Course) -> Mask:
    """Samples in which a free muscle sticks: its pressure turned, and later it follows.

    What a machine moves follows no pressure, nor does what a frame holds that yields.
    What does lies still until its friction
    has turned round, and that lies anywhere between the two directions until then. So
    it does where a sweep begins: nobody knows how the muscle came there. And so it does
    where its pressure turns again, or the sweep ends, before it has gone as far as the
    muscle needed to follow other times, or as muscles need.
    """
    found = np.zeros(len(course), dtype=bool)
    ways = _free_ways(course)
    if not any(way.is_followed for way in ways):
        return found
    pressure = course.level("pressure")
    top = float(np.max(np.abs(pressure)))
    turned = [way.gone(pressure)[-1] for way in ways if way.is_followed and way.start]
    enough = median(turned) if turned else STICKS * top
    for way in ways:
        gone = way.gone(pressure)
        least = SAGGED if gone[-1] > STUCK * top else SWINGS
        sags = gone > least * top if way.start else np.ones_like(gone, dtype=bool)
        # A regulator that overshot and holds has turned nothing.
        goes_on = gone[-1] > STUCK * top or _drives(pressure[way.rows], top)
        if way.is_followed:
            found[way.rows] = sags
            found[way.end - 1] = False
        elif not way.is_moved and goes_on:
            found[way.rows] = sags & (gone < enough)
    return binary_dilation(found, iterations=2)


def is_free(course: Course) -> bool:
    """Whether a muscle follows its pressure anywhere, and no machine moves it."""
    if not any(way.is_followed for way in _free_ways(course)):
        return False
    if np.isfinite(course.level("grip")).any():
        return True
    both = np.corrcoef(course.level("pressure"), course.level("contraction"))
    return bool(both[0, 1] > FOLLOWING)


class Way(NamedTuple):
    """From a turn of the pressure until something moves, or it turns again."""

    start: int
    end: int
    is_moved: bool
    is_followed: bool
    """Whether the muscle moves by that pressure, and no machine moves it."""

    @property
    def rows(self) -> slice:
        """Its samples."""
        return slice(self.start, self.end)

    def gone(self, pressure: Array) -> Array:
        """How far the pressure has gone since it turned. [Pa]."""
        return np.asarray(np.abs(pressure[self.rows] - pressure[self.start]))


def _free_ways(course: Course) -> tuple[Way, ...]:
    """Ways of a pressure that a muscle may follow; none where it hardly goes."""
    pressure = course.level("pressure")
    if not np.isfinite(pressure).all() or not course.direction.any():
        return ()
    top = float(np.max(np.abs(pressure)))
    if np.ptp(pressure) < SWEPT * top:
        return ()
    return tuple(_ways(course, travel(pressure, SWINGS * top), top))


def _ways(course: Course, sign: Array, top: float) -> Iterator[Way]:
    pressure, contraction = course.level("pressure"), course.level("contraction")
    # A step has turned the pressure before the first sample behind it.
    ends = (turn - 1 for turn, _ in _legs(sign, 0, len(course)))
    for turn, after in pairwise([0, *ends, len(course)]):
        gone = sign[after - 1] * (contraction[turn:after] - contraction[turn])
        moved = np.flatnonzero(np.abs(gone) > _followed(course))
        if not moved.size:
            yield Way(turn, after, is_moved=False, is_followed=False)
            continue
        end = turn + int(moved[0]) + 1
        # A smooth contraction sets out a little before its pressure does.
        follows = gone[moved[0]] > 0 and _drives(pressure[turn : end + BRIEF], top)
        yield Way(turn, end, is_moved=True, is_followed=bool(follows))


def _drives(pressure: Array, top: float) -> bool:
    """Whether a pressure goes on to the end of a stretch: what moves then follows it.

    What moves when it has long stood still, or hardly changed, is moved by a machine.
    """
    quarter = min(ceil(pressure.size / 4), pressure.size - 1)
    whole, last = (np.abs(pressure[-1] - pressure[at]) for at in (0, -1 - quarter))
    return bool(whole > SAGGED * top and last > DRIVING * whole)


def _followed(course: Course) -> float:
    """Way of the contraction from which it has followed a pressure. [-]."""
    known = course.smooth.get("contraction")
    return reversal(known.spread if known else 0.0)


def _legs(sign: Array, start: int, end: int) -> Iterable[tuple[int, int]]:
    """Where a way turns between two samples, each with where its new leg ends."""
    inside = sign[start:end]
    turns = start + 1 + np.flatnonzero(inside[1:] * inside[:-1] < 0)
    return pairwise([*turns.tolist(), end])
