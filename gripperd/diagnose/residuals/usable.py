"""Samples of a sweep that say something about a stage."""

from collections.abc import Iterable
from itertools import pairwise

import numpy as np
from scipy.ndimage import uniform_filter1d

from gripperd.diagnose.readings.course import Course, is_table
from gripperd.diagnose.readings.fault import Mask
from gripperd.diagnose.readings.leap import leaps
from gripperd.diagnose.readings.travel import (
    STUCK,
    leaning,
    noticed,
    reversal,
    travel,
)
from gripperd.diagnose.residuals.stages import INPUTS
from gripperd.model.effect import Signal
from gripperd.model.track import Array

NEIGHBOURS = 5
OFF = 3.0
"""Standard deviations of a mean of neighbours from which a smooth column is off. [-]"""

CORNER = 0.001
"""Share of the largest reading up to which a cut corner does not matter: the error
of good pressure transmitters. [-]"""

PRESSED = 5.0
"""Standard deviations of its noise from which a grip is one. [-]"""

DRIVING = 0.1
"""Share of a way of pressure that lies in its last quarter, if it still goes on. [-]"""

LOOSE = 0.98
"""Sign of friction from which joints that stuck have come loose. [-]"""


def usable(course: Course, signal: Signal) -> Mask:
    """Samples of a signal that say something about its stage.

    Parameters
    ----------
    course
        The sweep.
    signal
        What is predicted.
    """
    measured = course.column(signal.value)
    good = np.isfinite(measured)
    for name in INPUTS[signal]:
        good &= np.isfinite(course.level(name)) & ~_bridged(course, name)
    if signal is Signal.GRIP:
        # Without contact the jaws are moved by the muscle alone and press on nothing.
        good &= (measured > PRESSED * course.hush("grip")) & np.isfinite(
            course.column("force")
        )
        good &= ~_turning(leaning(course.level("force")))
    sweeps = "pressure" in course.smooth and not is_table((course,))
    if sweeps and signal in (Signal.FORCE, Signal.PRESSURE):
        good &= ~_transients(course)
    if signal is Signal.FORCE:
        good &= ~_reversals(course) & ~_missed(course, "pressure")
    if sweeps and signal is Signal.FORCE:
        good &= ~_stuck(course) & ~_late(course)
    return good


def _bridged(course: Course, name: str) -> Mask:
    """Samples amid readings that are missing in a row: what was there is a guess."""
    gone = ~np.isfinite(course.column(name))
    ends = np.flatnonzero(np.diff(gone, prepend=False, append=False))
    for start, end in ends.reshape(-1, 2).tolist():
        gone[start:end] = end - start > NEIGHBOURS
    return gone & np.isfinite(course.level(name))


def _missed(course: Course, name: str) -> Mask:
    """Samples next to a corner that the smooth column cuts.

    There the neighbours lie off to one side, which their noise alone does not.
    """
    known = course.smooth.get(name)
    if known is None or known.variance <= 0:
        return np.zeros(len(course), dtype=bool)
    off = np.nan_to_num(course.column(name) - known.value)
    # A sample in the middle of a step is left out as such, and not those around it.
    off[_transients(course)] = 0.0
    mean = uniform_filter1d(off, NEIGHBOURS, mode="nearest")
    sure = OFF * (known.variance / NEIGHBOURS) ** 0.5
    least = CORNER * float(np.max(np.abs(known.value)))
    return _widened(np.abs(mean) > max(sure, least), 2)


def _turning(sign: Array) -> Mask:
    """Samples while friction turns round: which way the joints rub is not known."""
    loose = np.flatnonzero(np.abs(sign) > LOOSE)
    if not loose.size:
        return np.zeros(sign.size, dtype=bool)
    index = np.arange(sign.size)
    after = np.minimum(np.searchsorted(loose, index), loose.size - 1)
    before = np.maximum(np.searchsorted(loose, index, side="right") - 1, 0)
    turning = np.sign(sign[loose[before]]) != np.sign(sign[loose[after]])
    return _widened(turning | (index < loose[0]), 2)


def _reversals(course: Course) -> Mask:
    """Samples next to a reversal: which side of it they lie on is not known.

    As many before it as after it, until the way back is seen to have begun.
    """
    sign, way = course.direction, course.level("contraction")
    turned = np.diff(sign, prepend=sign[0]) != 0
    near = _widened(turned, 2)
    if not turned.any():
        return near
    known = course.smooth["contraction"]
    seen = noticed(known.variance**0.5, reversal(known.spread))
    ends = [*np.flatnonzero(turned).tolist(), sign.size]
    start = 0
    for place, end in pairwise(ends):
        came = sign[place - 1]
        furthest = np.max(came * way[start:place])
        reach = int(np.argmax(furthest - came * way[place:end] > seen))
        near[max(place - reach, 0) : place + reach] = True
        start = place
    return near


def _stuck(course: Course) -> Mask:
    """Samples in which jaws hold on and do not follow a pressure that has turned.

    The muscle goes by less than is measured, or sticks: until its contraction has
    followed, its friction lies anywhere between the two directions.
    """
    stuck = np.zeros(len(course), dtype=bool)
    grip, pressure = course.level("grip"), course.level("pressure")
    if not (np.isfinite(grip).any() and np.isfinite(pressure).all()):
        return stuck
    grip = np.nan_to_num(grip - np.nanmin(grip))
    holds = (grip > PRESSED * course.hush("grip")) & (grip > 0)
    least = STUCK * float(np.ptp(pressure))
    sign, way = travel(pressure, least), course.level("contraction")
    followed = _followed(course)
    ends = np.flatnonzero(np.diff(holds, prepend=False, append=False))
    for start, end in ends.reshape(-1, 2).tolist():
        for turn, after in _legs(sign, start, end):
            gone = sign[turn] * (way[turn:after] - way[turn])
            stuck[turn:after] = ~np.logical_or.accumulate(gone > followed)
    return _widened(stuck, 2)


def _late(course: Course) -> Mask:
    """Samples in which a free muscle sticks: its pressure turned, and later it follows.

    What a machine moves follows no pressure. What does lies still until its friction
    has turned round, and that lies anywhere between the two directions until then. So
    it does where a sweep begins: nobody knows how the muscle came there. And so it does
    where its pressure turns again before it has gone as far as the muscle needed to
    follow any other time.
    """
    late = np.zeros(len(course), dtype=bool)
    pressure, way = course.level("pressure"), course.level("contraction")
    if not np.isfinite(pressure).all():
        return late
    # Of its height, not of its range: what is left of an isobar turns nothing.
    sign = travel(pressure, STUCK * float(np.max(np.abs(pressure))))
    followed = _followed(course)
    turns = [0, *(turn for turn, _ in _legs(sign, 0, len(course))), len(course)]
    turned, never = [], []
    for turn, after in pairwise(turns):
        gone = sign[after - 1] * (way[turn:after] - way[turn])
        moved = np.flatnonzero(np.abs(gone) > followed)
        if not moved.size:
            never.append(slice(turn, after))
        elif gone[moved[0]] > 0 and (turn or _drives(pressure[: moved[0] + 1])):
            late[turn : turn + moved[0]] = True
            if turn:
                turned.append(abs(pressure[turn + moved[0]] - pressure[turn]))
    for leg in never if turned else ():
        late[leg] = np.abs(pressure[leg] - pressure[leg.start]) < min(turned)
    return _widened(late, 2)


def _drives(pressure: Array) -> bool:
    """Whether a pressure goes on to the end of a stretch: what moves then follows it.

    What moves when it has long stood still is moved by a machine.
    """
    whole, last = (
        np.abs(pressure[-1] - pressure[at]) for at in (0, -pressure.size // 4)
    )
    return bool(last > DRIVING * whole)


def _followed(course: Course) -> float:
    """Way of the contraction from which it has followed a pressure. [-]."""
    known = course.smooth.get("contraction")
    return reversal(known.spread if known else 0.0)


def _legs(sign: Array, start: int, end: int) -> Iterable[tuple[int, int]]:
    """Where a way turns between two samples, each with where its new leg ends."""
    inside = sign[start:end]
    turns = start + 1 + np.flatnonzero(inside[1:] * inside[:-1] < 0)
    return pairwise([*turns.tolist(), end])


def _widened(near: Mask, reach: int) -> Mask:
    wide = near.copy()
    for shift in range(1, reach + 1):
        wide[shift:] |= near[:-shift]
        wide[:-shift] |= near[shift:]
    return wide


def _transients(course: Course) -> Mask:
    """Samples next to a step of pressure: two sensors never see it at once."""
    pressure, current = course.level("pressure"), course.column("current")
    near = leaps(pressure, float(np.nanmax(np.abs(pressure))), course.step)
    if np.isfinite(current).all():
        near |= leaps(current, float(np.max(np.abs(current))), course.step)
    return _widened(near, 2)
