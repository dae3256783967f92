"""Whether the valve is shut while the command stands still: the pressure tells.

No column says so. But where it sinks in one hold and stays in another, as high and as
long, a regulator keeps it in the other.
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
SINKS = 0.015
"""Share of the highest pressure from which it is no drift of a sensor: two standard
deviations of what sound ones drift. [-]"""
STEADY = 0.2
"""Least share of it lost in the second half: a lag is over by then. [-]"""
KEPT = 1 / 3
"""Share of what the slowest leak would lose, up to which a hold loses nothing. [-]"""


class Hold(NamedTuple):
    """What a pressure does while the command stands still."""

    sweep: int
    rows: Mask
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

    That is the time since the command last moved; 0 where a regulator keeps the
    pressure, which only a recording tells in which others sink.
    """
    waits = [course.still for course in courses]
    holds = [hold for place in range(len(courses)) for hold in _holds(courses, place)]
    top = max((hold.level for hold in holds), default=0.0)
    sinking = [hold for hold in holds if _sinks(hold, SINKS * top)]
    slowest = min((hold.pace for hold in sinking), default=0.0)
    least = SINKS * top / KEPT
    foreseen = [slowest * hold.level * hold.lasts for hold in holds]
    if not any(
        one > max(least, hold.lost / KEPT)
        for one, hold in zip(foreseen, holds, strict=True)
    ):
        return waits
    shut = [np.zeros(len(course), dtype=bool) for course in courses]
    for hold in sinking:
        shut[hold.sweep] |= hold.rows
    return [np.where(rows, wait, 0.0) for rows, wait in zip(shut, waits, strict=True)]


def _sinks(hold: Hold, least: float) -> bool:
    return hold.lost > least and hold.later > STEADY * hold.lost


def _holds(courses: Sequence[Course], place: int) -> Iterator[Hold]:
    """From each command to the next, if it rests for long."""
    course = courses[place]
    pressure, still = course.level("pressure"), course.still
    moved = np.cumsum(np.diff(still, prepend=0.0) < 0)
    for number in range(int(moved[-1]) + 1):
        rows = moved == number
        good = rows & (still > SETTLED) & np.isfinite(pressure)
        time, level = course.time[good], pressure[good]
        if good.sum() < 10 or time[-1] - time[0] < LONG:
            continue
        tenth = max(good.sum() // 10, 1)
        first, last = level[:tenth].mean(), level[-tenth:].mean()
        middle = float(np.interp(0.5 * (time[0] + time[-1]), time, level))
        lasts = float(time[-1] - time[0])
        if first > 0:
            yield Hold(place, rows, first, first - last, middle - last, lasts)
