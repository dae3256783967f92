"""Legs of a travel, each one way: no more of them than the readings bear out.

References
----------
.. [1] R. E. Barlow, D. J. Bartholomew, J. M. Bremner, H. D. Brunk, "Statistical
       Inference under Order Restrictions", Wiley, 1972: the likeliest monotone way.
"""

from itertools import pairwise

import numpy as np
from scipy.optimize import isotonic_regression

from gripperd.model.track import Array

BORNE_OUT = 10.0
"""By how much likelier readings are with a leg that they bear out: a way that turns
follows noise as well. [nat]"""
BESIDE = 3.0
"""Standard deviations of a mean within which a first leg is no way gone. [-]"""


def legs_of(signs: Array) -> list[slice]:
    """Stretches between reversals; where a sign is 0 is no leg."""
    turns = np.flatnonzero(np.diff(signs)) + 1
    ends = pairwise([0, *turns.tolist(), signs.size])
    return [slice(start, end) for start, end in ends if signs[start] != 0]


def borne_out(signs: Array, column: Array, variance: float) -> Array:
    """Take back every leg that noise alone would make, the least sure first.

    A trend that is supple beside a corner follows what noise does there; where the way
    ends, what is left of it then looks like a way back.

    Parameters
    ----------
    signs
        Of the travel along the trend, 1 or -1; 0 where there is none yet.
    column
        What was measured, shape ``(n,)``; NaN tells nothing.
    variance
        Of its noise, as a mean over many samples sees it.
    """
    found = signs.copy()
    while len(legs := legs_of(found)) > 1:
        around = [legs[max(place - 1, 0) : place + 2] for place in range(len(legs))]
        told = [
            _misfit(column[near[0].start : near[-1].stop], -found[leg.start])
            - sum(_misfit(column[one], found[one.start]) for one in near)
            for leg, near in zip(legs, around, strict=True)
        ]
        least = int(np.argmin(told))
        if told[least] > 2 * BORNE_OUT * variance:
            break
        leg = legs[least]
        rests = least == 0 and _stays(column, leg, variance)
        found[leg] *= 0 if rests else -1
    return found


def _stays(column: Array, leg: slice, variance: float) -> bool:
    """Whether a first leg is where the column was before, but for its noise."""
    before, there = column[: leg.start], column[leg]
    if not (np.isfinite(before).any() and np.isfinite(there).any()):
        return False
    apart = float(np.nanmean(there)) - float(np.nanmean(before))
    return bool(abs(apart) < BESIDE * variance**0.5)


def _misfit(column: Array, sign: float) -> float:
    """Sum of squares that the likeliest way one way leaves [1]_."""
    way = sign * column[np.isfinite(column)]
    return float(np.sum((way - isotonic_regression(way).x) ** 2)) if way.size else 0.0
