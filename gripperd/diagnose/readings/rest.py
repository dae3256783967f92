"""Rests: a length that is held, and may have been brought there first.

References
----------
.. [1] D. M. Hawkins, "Testing a sequence of observations for a shift in location",
       J. Am. Stat. Assoc. 72(357), 180-186, 1977: the likeliest place of one shift.
"""

import numpy as np

from gripperd.diagnose.noise.smoothing import Smooth
from gripperd.diagnose.readings.legs import BORNE_OUT
from gripperd.diagnose.readings.travel import reversal
from gripperd.model.track import Array

LEAST = 10
"""Samples before a shift and after it, that one outlier makes none."""


def at_rest(column: Array, known: Smooth) -> Array:
    """Level of a length that does not travel: one mean, or one each side of a shift.

    A carriage that comes to its length as a record begins would leave all of it at a
    length where it never was. There is a shift if readings bear it out, it is a way
    that would turn one round, and the trend goes no other way.

    Parameters
    ----------
    column
        What was measured, shape ``(n,)``; NaN tells nothing.
    known
        Its trend.
    """
    held = np.full_like(known.value, known.value.mean())
    good = np.flatnonzero(np.isfinite(column))
    if good.size <= 2 * LEAST:
        return held
    reading = column[good]
    place = LEAST + int(np.argmax(_between(reading)[LEAST:-LEAST]))
    levels = reading[:place].mean(), reading[place:].mean()
    shifted = np.where(np.arange(column.size) < good[place], *levels)
    misfits = [
        float(np.sum((reading - way[good]) ** 2))
        for way in (held, shifted, known.value)
    ]
    told = 2 * BORNE_OUT * known.variance
    far = abs(levels[1] - levels[0]) > reversal(known.spread)
    borne_out = misfits[0] - misfits[1] > told
    no_other = misfits[1] - misfits[2] < told
    return shifted if far and borne_out and no_other else held


def _between(reading: Array) -> Array:
    """Sum of squares that a shift before each sample takes away, none before the first.

    Shape ``(n,)``: the statistic of [1]_, squared.
    """
    before = np.arange(reading.size)
    after = reading.size - before
    gone = np.concatenate([[0.0], np.cumsum(reading - reading.mean())[:-1]])
    return np.asarray(gone**2 * reading.size / np.maximum(before, 1) / after)
