"""Samples of a sweep that say something about a stage."""

from itertools import pairwise
from weakref import WeakKeyDictionary

import numpy as np
from scipy.ndimage import binary_dilation, uniform_filter1d

from gripperd.diagnose.readings.course import Course, is_table
from gripperd.diagnose.readings.fault import Mask
from gripperd.diagnose.readings.grasp import PRESSED
from gripperd.diagnose.readings.leap import leaps
from gripperd.diagnose.readings.sticking import late, stuck
from gripperd.diagnose.readings.travel import (
    LOOSE,
    leaning,
    noticed,
    reversal,
    travel,
)
from gripperd.diagnose.residuals.explanation import AtRest
from gripperd.diagnose.residuals.stages import INPUTS
from gripperd.diagnose.residuals.track import TURNED as INFLATED
from gripperd.diagnose.residuals.track import turning
from gripperd.model.effect import Signal
from gripperd.model.track import Array

NEIGHBOURS = 5
OFF = 3.0
"""Standard deviations of a mean of neighbours from which a smooth column is off. [-]"""

CORNER = 0.001
"""Share of the largest reading up to which a cut corner does not matter: the error
of good pressure transmitters. [-]"""

ARRIVED = 2.0
"""Time in which a pressure has come to rest, but for a leak. [s]"""

BESIDE = 0.05
"""Share of its highest by which a pressure lies beside the line of its valve, for those
in use bend by less; one that begins twice as far off comes from elsewhere. [-]"""

TURNED = 0.1
"""Share of the way by which friction has turned round from which it is turning. [-]"""

STANDS = 0.2
"""The same within which a pressure that has turned may as well stand, if that is no
further than its trend is known. [-]"""

_KNOWN: WeakKeyDictionary[Course, dict[Signal, Mask]] = WeakKeyDictionary()
"""What was told before: a sweep is the same in every problem it is a part of."""


def usable(course: Course, signal: Signal) -> Mask:
    """Samples of a signal that say something about its stage.

    Parameters
    ----------
    course
        The sweep.
    signal
        What is predicted.
    """
    known = _KNOWN.setdefault(course, {})
    if signal not in known:
        known[signal] = _usable(course, signal)
    return known[signal].copy()


def _usable(course: Course, signal: Signal) -> Mask:
    measured = course.column(signal.value)
    good = np.isfinite(measured)
    for name in INPUTS[signal]:
        good &= np.isfinite(course.level(name)) & ~_bridged(course, name)
    # A pull that no cell tells is followed in the grip.
    pulls = signal is Signal.FORCE or (signal is Signal.GRIP and course.is_blind)
    if signal is Signal.GRIP:
        good &= _pressing(course)
    sweeps = "pressure" in course.smooth and not is_table((course,))
    if sweeps and (pulls or signal is Signal.PRESSURE):
        good &= ~_transients(course)
    if sweeps and signal is Signal.PRESSURE:
        good &= ~(_arriving(course) | _astray(course))
    if pulls:
        good &= ~_reversals(course) & ~_missed(course, "pressure")
        good &= ~_winding(course)
        if course.direction.any():
            # What may have been gone there and back had its friction as well.
            good &= ~_unsure(course) & ~_missed(course, "contraction")
    if sweeps and pulls:
        good &= ~stuck(course) & ~late(course) & ~_inflating(course)
    return good


def _pressing(course: Course) -> Mask:
    """Samples in which jaws press, by a load that does not turn round.

    Joints may rub the way of the travel as well: where that turns round, if it is not
    that of the load.
    """
    # Without contact the jaws are moved by the muscle alone and press on nothing.
    good = course.column("grip") > PRESSED * course.hush("grip")
    name = "pressure" if course.is_blind else "force"
    good &= np.isfinite(course.column(name)) & np.isfinite(course.level(name))
    if course.clamped or not good.any():
        return np.zeros_like(good)
    sign = leaning(course.level(name))
    apart = np.sign(sign) != course.direction
    turning = _turning(sign) | (apart & _reversals(course))
    return np.asarray(good & ~turning)


def _bridged(course: Course, name: str) -> Mask:
    """Samples amid readings that are missing in a row: what was there is a guess."""
    gone = ~np.isfinite(course.column(name))
    ends = np.flatnonzero(np.diff(gone, prepend=False, append=False))
    for start, end in ends.reshape(-1, 2).tolist():
        gone[start:end] = end - start > NEIGHBOURS
    return gone & np.isfinite(course.level(name))


def _unsure(course: Course) -> Mask:
    """Samples of a leg that the readings do not bear out: its friction is not known."""
    known = course.smooth.get("contraction")
    unsure = np.full(len(course), False if known is None else known.unsure)
    return binary_dilation(unsure, iterations=2)


def _missed(course: Course, name: str) -> Mask:
    """Samples next to a corner that the smooth column cuts.

    There the neighbours lie off to one side, which their noise alone does not.
    """
    known = course.smooth.get(name)
    # What a trend with its corners leaves is noise, which is off now and then.
    if known is None or known.variance <= 0 or known.broken:
        return np.zeros(len(course), dtype=bool)
    off = np.nan_to_num(course.column(name) - known.value)
    # A sample in the middle of a step is left out as such, and not those around it.
    off[_transients(course)] = 0.0
    mean = uniform_filter1d(off, NEIGHBOURS, mode="nearest")
    sure = OFF * (known.variance / NEIGHBOURS) ** 0.5
    least = CORNER * float(np.max(np.abs(known.value)))
    missed = np.abs(mean) > max(sure, least)
    if course.on_stairs:
        # Corners lie so close that neighbours are off to either side.
        missed |= np.abs(off) > max(OFF * known.variance**0.5, least)
    return binary_dilation(missed, iterations=2)


def _turning(sign: Array) -> Mask:
    """Samples while friction turns round: which way the joints rub is not known.

    Nor is it where their load went more than half the way that turns it, and came back.
    """
    loose = np.abs(sign) > LOOSE
    if not loose.any():
        return np.zeros(sign.size, dtype=bool)
    # Of each sample the last that was loose; joints begin with no sign at all.
    since = np.maximum.accumulate(np.where(loose, np.arange(sign.size), -1))
    away = np.sign(sign) != np.sign(sign[since])
    turned = np.bincount(since + 1, weights=away) > 0
    return binary_dilation(turned[since + 1] & ~loose, iterations=2)


def _reversals(course: Course) -> Mask:
    """Samples next to a reversal: which side of it they lie on is not known.

    As many before it as after it, until the way back is seen to have begun.
    """
    sign, way = course.direction, course.level("contraction")
    turned = np.diff(sign, prepend=sign[0]) != 0
    near = binary_dilation(turned, iterations=2)
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


def _inflating(course: Course) -> Mask:
    """Samples while a pressure turns friction round where nothing travels.

    How much of it nobody knows, nor how far the pressure went between two readings, and
    back; nor which way it came that stood before it set out. What stands turns nothing.
    """
    known = course.smooth.get("pressure")
    away = OFF * known.spread if known else 0.0
    found = np.zeros(len(course), dtype=bool)
    halts = course.halts if course.direction.any() else (slice(0, len(course)),)
    for halt in halts:
        found[halt] = _turning_with(course.level("pressure")[halt], away)
    return found


def _turning_with(pressure: Array, away: float) -> Mask:
    found = np.zeros(pressure.size, dtype=bool)
    way = 2 * turning(pressure, INFLATED[AtRest.INFLATING])
    sign = travel(pressure, way)
    first = int(np.argmax(sign != 0))
    if first >= NEIGHBOURS:
        sign[:first] = -sign[first]
    turns = 1 + np.flatnonzero(sign[1:] * sign[:-1] < 0)
    for start, end in pairwise([*turns.tolist(), sign.size]):
        gone = np.abs(pressure[start - 1 : end] - pressure[start - 1])
        back = int(np.argmax(gone > way))
        stood = np.flatnonzero(gone[: back + 1] <= min(STANDS * way, away))[-1]
        found[start - 1 + stood : start - 1 + back] = True
    return found


def _winding(course: Course) -> Mask:
    """Samples of a muscle whose frame yields, while its friction turns round."""
    found = np.zeros(len(course), dtype=bool)
    if not course.yields:
        return found
    way, seen = course.level("contraction"), noticed(0.0)
    sign = travel(way, TURNED * seen)
    turns = 1 + np.flatnonzero(sign[1:] * sign[:-1] < 0)
    for start, end in pairwise([*turns.tolist(), sign.size]):
        gone = np.abs(way[start:end] - way[start])
        found[start:end] = ~np.logical_or.accumulate(gone > seen)
    return found


def _arriving(course: Course) -> Mask:
    """Samples in which a sweep begins under way: nobody knows where it came from.

    Its command has stood still since it began, and its pressure comes to rest.
    """
    pressure, current = course.level("pressure"), course.column("current")
    found = np.zeros(len(course), dtype=bool)
    if not np.isfinite(current).all():
        return found
    still = np.abs(current - current[0]) <= CORNER * np.max(np.abs(current))
    early = course.time - course.time[0] < ARRIVED
    end = int(np.argmin(np.append(still & early, False)))
    if end < 2 * NEIGHBOURS:
        return found
    away = np.abs(pressure[:end] - np.median(pressure[end - NEIGHBOURS : end]))
    sure = max(
        OFF * course.hush("pressure") / NEIGHBOURS**0.5,
        CORNER * float(np.nanmax(np.abs(pressure))),
    )
    if np.max(away[:NEIGHBOURS]) > 2 * sure:
        found[: int(np.flatnonzero(away > sure)[-1]) + NEIGHBOURS] = True
    return found


def _astray(course: Course) -> Mask:
    """Samples in which a sweep begins far from its command, and comes to it.

    What was asked for before it began is not known, though it goes on at once.
    """
    pressure, current = course.column("pressure"), course.column("current")
    found = np.zeros(len(course), dtype=bool)
    known = np.isfinite(pressure + current)
    if known.sum() < 2 * NEIGHBOURS or np.ptp(current[known]) == 0:
        return found
    line = np.polynomial.Polynomial.fit(current[known], pressure[known], 1)
    away = np.abs(pressure - line(current))
    off, far = (
        max(times * float(np.nanmedian(away)), share * float(np.nanmax(pressure)))
        for times, share in ((OFF, BESIDE), (2 * OFF, 2 * BESIDE))
    )
    there = (away <= off) & (course.time - course.time[0] < ARRIVED)
    came = int(np.argmax(there))
    gone = abs(pressure[came] - pressure[known][0])
    if there.any() and away[known][0] > far and gone > off:
        found[: came + NEIGHBOURS] = True
    return found


def _transients(course: Course) -> Mask:
    """Samples next to a step of pressure: two sensors never see it at once."""
    pressure, current = course.level("pressure"), course.column("current")
    near = leaps(pressure, float(np.nanmax(np.abs(pressure))), course.step)
    if np.isfinite(current).all():
        near |= leaps(current, float(np.max(np.abs(current))), course.step)
    return binary_dilation(near, iterations=2)
