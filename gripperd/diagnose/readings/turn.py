"""When a way turns, by the readings about it: friction turns round with the way.

A trend goes past the end of a way that is held and comes back, so that it seems to turn
amid the rest: it turns at its end, with the way back.
"""

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from gripperd.diagnose.noise.smoothing import Smooth
from gripperd.diagnose.readings.bend import bend
from gripperd.diagnose.readings.fault import Mask
from gripperd.diagnose.readings.travel import OVERSHOOT, noticed, reversal
from gripperd.model.track import Array

DEPTH = 5.0
"""Times the way back that counts as reversed, up to which a turn is looked at."""
PART = 0.25
"""The same, of the shorter of its two ways: the longer they are, the better is a rest
told from a round turn. [-]"""


class Turned(NamedTuple):
    """Where a way turns, shape ``(n,)`` each."""

    signs: Array
    """Of its travel; 0 before there was any."""
    unsure: Mask
    """Samples before or after a turn, nobody knows which."""


def turned(signs: Array, time: Array, column: Array, known: Smooth) -> Turned:
    """Let a way turn where its readings do, if they are of a shape that is known.

    Parameters
    ----------
    signs
        Of the travel, as a trend has it, shape ``(n,)``; 0 before there was any.
    time
        Rising, shape ``(n,)``. [s]
    column
        The readings that the trend was laid through.
    known
        The trend.
    """
    found = Turned(signs.copy(), np.zeros(signs.size, dtype=bool))
    turns = 1 + np.flatnonzero(signs[1:] * signs[:-1] < 0)
    if not (turns.size and known.variance > 0 and np.isfinite(column).all()):
        return found
    reverses = reversal(known.spread)
    least, noise = DEPTH * reverses, noticed(known.variance**0.5, reverses)
    places = [0, *turns.tolist(), signs.size]
    for (start, place), end in zip(pairwise(places), places[2:], strict=False):
        came = signs[place - 1]
        way = came * known.value
        ways = np.ptp(way[start:place]), np.ptp(way[place:end])
        low = way < way[start:end].max() - max(least, PART * min(ways))
        first = start + int(np.append(0, np.flatnonzero(low[start:place]))[-1])
        last = place + int(np.append(np.flatnonzero(low[place:end]), end - place)[0])
        rows = slice(first, last)
        trend = 0.5 * (time[place - 1] + time[place])
        when = bend(time[rows], came * column[rows], known.variance, trend)
        if when is None:
            continue
        early, late = first + np.searchsorted(time[rows], when)
        found.signs[place:early] = came
        found.signs[late:place] = -came
        found.unsure[early:late] = True
        # Two rests with a small step between them look like one.
        back = way[place - 1] - way[place:early] > noise
        found.unsure[place:early] |= back & (np.count_nonzero(back) > OVERSHOOT)
    return found
