"""Direction of travel: along a measured way, or of what sticks under a load."""

import numpy as np
from scipy.ndimage import median_filter

from gripperd.diagnose.noise.smoothing import Smooth
from gripperd.model.compiled import compiled
from gripperd.model.memory import begin, stop
from gripperd.model.track import Array

TRAVEL = 1.5e-3
"""Contraction that must be undone before a travel counts as reversed. [-]"""
SURE = 3.5
"""The same in standard deviations of a contraction, as its past alone has it: with what
comes after it is known half as well again, and no trend beside a corner goes so far.
Much more, and the short ways of jaws on what yields are missed. [-]"""
NOTICED = (0.2, 0.4)
"""The least and the most of it that tells when the way back began. [-]"""
CLEAR = 1.5
"""The same in sigma of the noise that was taken off. [-]"""
STILL = 2.7
"""A sweep within a range of so many times that has no travel. [-]"""
JAWS = 1.0
"""The same of jaws, of which turns bear out that they move. [-]"""
ROUND, STRAIGHT = 0.5, 1.0
"""Power of the way with which the time since it turned goes: round, it leaves with the
square of the time, and straight from a corner. [-]"""
OVERSHOOT = 10
"""Samples of which a trend may swing past a corner. [-]"""
STUCK = 0.06
"""Half the way back, as a share of the range of the load, in which joints stick. [-]"""
STEADY = 0.01
"""The same of the load itself: a steady one turns nothing. [-]"""
LOOSE = 0.98
"""Sign of friction from which joints that stuck have come loose. [-]"""


def leaning(load: Array) -> Array:
    """Sign of friction in joints under a load, between the signs while they stick.

    Jaws on an object go by less than is measured; their load tells which way.
    """
    radius = max(STUCK * float(np.ptp(load)), STEADY * float(np.max(np.abs(load))))
    if not radius > 0:
        return np.zeros_like(load)
    return stop(load, radius, begin()) / radius


def reversal(spread: float) -> float:
    """Way back of a contraction so well known (one sigma) that reverses it. [-]."""
    return max(TRAVEL, SURE * spread)


def noticed(noise: float, least: float = TRAVEL) -> float:
    """Way back of a contraction that is told from noise (one sigma). [-]."""
    low, high = NOTICED
    return float(np.clip(CLEAR * noise, low * least, high * least))


def contracting(known: Smooth, still: float = STILL) -> Array:
    """Sign of travel of a contraction; 0 throughout if there is none, or unknown.

    There is none within a range of so many times the least way back.
    """
    least = reversal(known.spread)
    if not np.isfinite(known.value).all() or np.ptp(known.value) < still * least:
        return np.zeros_like(known.value)
    begun = noticed(known.variance**0.5, least)
    return travel(known.value, least, begun, STRAIGHT if known.broken else ROUND)


def travel(way: Array, least: float, begun: float = 0.0, turn: float = ROUND) -> Array:
    """Sign of travel along a way, turning where it turned; 0 before the first.

    A trend goes too far where jaws meet an object, and with the noise of the first few
    readings; the way that lasts is not that. What has no noise to begin with (begun 0)
    goes no further than it went.

    Parameters
    ----------
    way
        What goes there and back, shape ``(n,)``. [any]
    least
        How much must be undone before it counts as reversed. [of the way]
    begun
        How much is undone when the way back is seen to have begun. [of the way]
    turn
        Power of the way back with which the time since the turn goes. [-]
    """
    lasting, early = way, 0.0
    if begun > 0:
        lasting = median_filter(way, 2 * OVERSHOOT + 1, mode="reflect")
        early = (begun / least) ** turn
    return compiled(_travel)(way, lasting, (least, begun), early, OVERSHOOT)


def _travel(
    way: Array, lasting: Array, ways: tuple[float, float], early: float, brief: int
) -> Array:
    least, begun = ways
    out = np.zeros_like(way)
    sign = 0.0
    leg = 0
    extreme, top = way[0], 0
    for i in range(way.size):
        gone = (way[i] - extreme) * (sign if sign != 0.0 else 1.0)
        if sign != 0.0 and gone >= 0:
            extreme, top = way[i], i
        elif abs(gone) > least:
            ahead = 1.0 if way[i] > extreme else -1.0
            plateau = i - 1
            while abs(way[plateau] - extreme) > begun:
                plateau -= 1
            furthest = -ahead * np.max(-ahead * lasting[leg:i])
            last = i - 1
            while last > plateau and abs(way[last] - furthest) > begun:
                last -= 1
            too_far = abs(extreme - furthest) > begun
            if too_far and last > plateau + brief:
                extreme, top, plateau = furthest, last - brief, last
            leg = plateau
            # A turn leaves as it came; the first leg came from nowhere, it begins with
            # its plateau.
            before = (i - plateau - 1) * early / (1 - early)
            came = 0 if sign != 0.0 else plateau
            while came < top and abs(way[top - came] - extreme) <= begun:
                came += 1
            sign = ahead
            out[plateau - int(min(before, came, plateau - top)) + 1 : i] = sign
            extreme, top = way[i], i
        out[i] = sign
    return out
