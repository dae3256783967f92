"""Whether a regulator keeps the pressure while the command rests, or the valve is shut.

No column says so. But where the pressure sinks in one hold and stays in another, as
high and as long, a regulator keeps it in the other. A cock that is shut or opened by
hand amid a hold shows in the pressure alone: it begins to sink, or comes back at once.
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from gripperd.diagnose.readings.course import Course
from gripperd.diagnose.readings.fault import Mask
from gripperd.model.track import Array

SETTLED = 1.0
"""Time after which a regulator has followed a command. [s]"""
LONG = 5.0
"""Time from which a hold shows whether it sinks. [s]"""
FEW = 10
"""Samples from which it does: a tenth of them is one. [-]"""
SINKS = 0.015
"""Share of the highest pressure from which it is no drift of a sensor: two standard
deviations of what sound ones drift. [-]"""
STEADY = 0.2
"""Least share of it lost in the second half: a lag is over by then. [-]"""
KEPT = 1 / 2
"""Share of what the slowest leak would lose, below which holds lose nothing: from 400
to 160 kPa the pace of an orifice, of the root of the pressure, changes by 1.6. [-]"""
FEEDS, FASTER = 0.0, 1.5
"""Times the pace of half of the holds that sink from which one is shut: if any is, and
if the regulator feeds the leak in the others. [-]"""
REFILLED = 6.0
"""Standard deviations by which readings rise from one window to the next where a cock
is opened; noise alone does so once in 1e9 windows. [-]"""
WINDOW = 3.0
"""Its length: a regulator has filled up by then. [s]"""
LEAST = 5
"""Samples of it."""
BACK = 0.5
"""Share of the rise that had been lost since the regulator had followed. [-]"""
CLEARLY = 30.0
"""Fall of the misfit, in squares of what is left, from which a pressure that sinks has
stayed at first. Of 2000 drawn leaks one in a thousand fell by 8 by chance, by 38 where
neighbours correlate by 0.6. [-]"""
STARTS = 60
"""Places in a hold at which it may have begun to sink."""


class Hold(NamedTuple):
    """What a pressure does while the command stands still."""

    rows: Mask
    settled: Mask
    """Those of them after the regulator has followed."""
    level: float
    """Where it begins. [Pa]"""
    lost: float
    """From the first tenth to the last. [Pa]"""
    later: float
    """The same from the middle on. [Pa]"""
    lasts: float
    """[s]."""

    @property
    def pace(self) -> float:
        """Share lost per time. [1/s]."""
        return self.lost / (self.level * self.lasts)


def waiting(courses: Sequence[Course]) -> list[Array]:
    """Time for which the valve may have been shut, in every sweep. [s].

    That is the time since the command last moved, in all holds. But if a regulator is
    known to keep those that do not sink, for the slowest leak would drain them by far
    more than they lose, the time is 0 there.
    """
    holds = [hold for course in courses for hold in _holds(course)]
    least = _least(holds)
    slowest = min((hold.pace for hold in holds if _sinks(hold, least)), default=0.0)
    stay = [hold for hold in holds if not _sinks(hold, least)]
    due = slowest * np.array([hold.level * hold.lasts for hold in stay])
    lost = np.array([hold.lost for hold in stay])
    # The share of what is due that all of them lost, and two standard deviations of it.
    if due @ lost + least * np.sqrt(due @ due) >= KEPT * (due @ due):
        return [resting(course) for course in courses]
    return sinking(courses)


def sinking(courses: Sequence[Course]) -> list[Array]:
    """The same if but those that sink may be shut. [s]."""
    return _shut(courses, FEEDS)


def sinking_faster(courses: Sequence[Course]) -> list[Array]:
    """The same if a regulator feeds the leak in those that sink the slowest. [s]."""
    return _shut(courses, FASTER)


def _shut(courses: Sequence[Course], faster: float) -> list[Array]:
    """The same in what sinks, and so much faster than half of what does. [s]."""
    held = [list(_holds(course)) for course in courses]
    least = _least([hold for own in held for hold in own])
    paces = [hold.pace for own in held for hold in own if _sinks(hold, least)]
    usual = float(np.quantile(paces, 0.5, method="lower")) if paces else 0.0
    found = []
    for course, own in zip(courses, held, strict=True):
        waits = np.zeros(len(course))
        for hold in own:
            if _sinks(hold, least) and hold.pace >= faster * usual:
                began = _sank_from(course, hold)
                waits[hold.rows] = np.maximum(course.time[hold.rows] - began, 0.0)
        found.append(waits)
    return found


def _least(holds: Sequence[Hold]) -> float:
    """Fall from which a pressure sinks. [Pa]."""
    return SINKS * max((hold.level for hold in holds), default=0.0)


def _sinks(hold: Hold, least: float) -> bool:
    return hold.lost > least and hold.later > STEADY * hold.lost


def _holds(course: Course) -> Iterator[Hold]:
    """From each command to the next, if it rests for long."""
    pressure, still = course.level("pressure"), resting(course)
    moved = np.cumsum(np.diff(still, prepend=0.0) < 0)
    for number in range(int(moved[-1]) + 1):
        rows = moved == number
        good = rows & (still > SETTLED) & np.isfinite(pressure)
        time, level = course.time[good], pressure[good]
        if time.size < FEW or np.ptp(time) < LONG:
            continue
        tenth = time.size // FEW
        first, last = (float(part.mean()) for part in (level[:tenth], level[-tenth:]))
        middle = float(np.interp(0.5 * (time[0] + time[-1]), time, level))
        if first > 0:
            lost, later = first - last, middle - last
            yield Hold(rows, good, first, lost, later, float(np.ptp(time)))


def resting(course: Course) -> Array:
    """Time since the command last moved, or a cock was opened while it rested. [s]."""
    opened = np.where(_opened(course), course.time, -np.inf)
    return np.minimum(course.still, course.time - np.maximum.accumulate(opened))


def _opened(course: Course) -> Mask:
    """Samples at which a pressure comes back, of which some was lost at rest."""
    found = np.zeros(len(course), dtype=bool)
    time, still = course.time, course.still
    lasts = max(LEAST * float(np.median(course.step)), WINDOW)
    means = _Means(time, course.column("pressure"))
    before, number = means.within(time - lasts, time)
    after, more = means.within(time, time + lasts)
    moved = time - still
    first, _ = means.within(moved + SETTLED, moved + SETTLED + lasts)
    rise, lost = after - before, first - before
    few = np.minimum(number, more) < LEAST
    noise = course.hush("pressure") * np.sqrt(
        1 / np.maximum(number, 1) + 1 / np.maximum(more, 1)
    )
    rises = (rise > REFILLED * noise) & (lost > BACK * rise) & ~few
    rises &= still > 2 * SETTLED + lasts
    for row in np.flatnonzero(rises):
        near = rises & (np.abs(time - time[row]) <= lasts)
        found[row] = rise[row] >= np.max(rise[near])
    return found


class _Means:
    """Means of a column over spans of time."""

    def __init__(self, time: Array, column: Array) -> None:
        known = np.isfinite(column)
        self._time = time
        self._sum = np.append(0.0, np.cumsum(np.where(known, column, 0.0)))
        self._number = np.append(0, np.cumsum(known))

    def within(self, start: Array, end: Array) -> tuple[Array, Array]:
        """Mean from each start until before each end, and of how many samples."""
        low, high = (np.searchsorted(self._time, one) for one in (start, end))
        number = np.maximum(self._number[high] - self._number[low], 0)
        total = self._sum[high] - self._sum[low]
        return np.where(number > 0, total / np.maximum(number, 1), np.nan), number


def _sank_from(course: Course, hold: Hold) -> float:
    """When a pressure that sinks began to: with its hold, unless clearly later. [s]."""
    began = float(course.time[hold.rows][0])
    good = hold.settled & np.isfinite(course.column("pressure"))
    if good.sum() < FEW:
        return began
    time, pressure = course.time[good], course.column("pressure")[good]
    starts = np.concatenate([[time[0]], np.linspace(time[0], time[-1], STARTS)[1:-1]])
    misfits = np.array([_misfit(time, pressure, start) for start in starts])
    best = int(np.argmin(misfits))
    if misfits[0] - misfits[best] > CLEARLY * misfits[best] / time.size:
        return float(starts[best])
    return began


def _misfit(time: Array, pressure: Array, start: float) -> float:
    """What a pressure that stays, and sinks on a bent way from a start on, leaves."""
    gone = np.maximum(time - start, 0.0) / np.ptp(time)
    ways = np.column_stack([np.ones_like(gone), gone, gone**2])
    left = pressure - ways @ np.linalg.lstsq(ways, pressure, rcond=None)[0]
    return float(left @ left)
