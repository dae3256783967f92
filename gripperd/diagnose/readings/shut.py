"""Whether a regulator keeps the pressure while the command rests, or the valve is shut.

No column says so. But where the pressure sinks in one hold and stays in another, as
high and as long, a regulator keeps it in the other.
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


class Hold(NamedTuple):
    """What a pressure does while the command stands still."""

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

    That is the time since the command last moved, in all holds. But if a regulator is
    known to keep those that do not sink, for the slowest leak would drain them by far
    more than they lose, the time is 0 there.
    """
    held = [list(_holds(course)) for course in courses]
    holds = [hold for own in held for hold in own]
    top = max((hold.level for hold in holds), default=0.0)
    least = SINKS * top
    slowest = min((hold.pace for hold in holds if _sinks(hold, least)), default=0.0)
    stay = [hold for hold in holds if not _sinks(hold, least)]
    due = slowest * np.array([hold.level * hold.lasts for hold in stay])
    lost = np.array([hold.lost for hold in stay])
    # The share of what is due that all of them lost, and two standard deviations of it.
    if due @ lost + least * np.sqrt(due @ due) >= KEPT * (due @ due):
        return [course.still for course in courses]
    found = []
    for course, own in zip(courses, held, strict=True):
        shut = np.zeros(len(course), dtype=bool)
        for hold in own:
            if _sinks(hold, least):
                shut |= hold.rows
        found.append(np.where(shut, course.still, 0.0))
    return found


def _sinks(hold: Hold, least: float) -> bool:
    return hold.lost > least and hold.later > STEADY * hold.lost


def _holds(course: Course) -> Iterator[Hold]:
    """From each command to the next, if it rests for long."""
    pressure, still = course.level("pressure"), course.still
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
            yield Hold(rows, first, first - last, middle - last, float(np.ptp(time)))
