"""A trend with corners: straight on between them, and at each another slope.

A triangle or a trapezoid that is run again and again has a corner every second. A trend
of one stiffness is either too supple for its legs or too stiff for its corners.

References
----------
.. [1] J. Durbin, S. J. Koopman, "Time Series Analysis by State Space Methods", 2nd
       ed., Oxford, 2012, section 7.5 (auxiliary residuals show where a slope breaks)
       and 7.3.4 (variances by the EM algorithm).
"""

from typing import NamedTuple

import numpy as np

from gripperd.diagnose.noise.trend import RARE, filtered, smoothed
from gripperd.model.compiled import compiled
from gripperd.model.track import Array

BREAKS = 2.0
"""Standard deviations of its usual change from which a slope breaks. [-]"""
ROUNDS = 12
"""Of looking for corners; a corner that is seen lets the next one be seen."""
LEG = 8
"""Samples from corner to corner on average, at least: what breaks more often is a curve
that is read too seldom, or quieter than told, and no straight way."""


class Cornered(NamedTuple):
    """A trend and where it breaks."""

    stiffness: Array
    """Spectral density of the slope at each sample, shape ``(n,)``. [1/s³]"""
    likelihood: float
    """Log density less what the corners cost; none where it is no trend. [nat]"""


def cornered(scaled: Array, step: Array, tried: Array, fast: float) -> Cornered:
    """Find the likeliest corners of a column.

    Parameters
    ----------
    scaled
        In standard deviations of its noise, shape ``(n,)``; NaN is bridged. [-]
    step
        Time since the sample before, shape ``(n,)``. [s]
    tried
        Spectral densities of the slope between corners. [1/s³]
    fast
        Rate with which it may begin. [1/s]
    """
    best, breaks = Cornered(np.full(step.size, tried[0]), -np.inf), 0
    for usual in tried.tolist():
        stiffness = np.full(step.size, usual)
        for _ in range(ROUNDS):
            density, states, spreads, leaps = compiled(filtered)(
                scaled, step, stiffness, np.inf, fast
            )
            corners = int(np.count_nonzero(stiffness > usual))
            likelihood = float(density.sum()) - RARE * corners
            if likelihood > best.likelihood:
                best, breaks = Cornered(stiffness, likelihood), corners
            slope = compiled(smoothed)(states, spreads, step, stiffness, leaps)[1]
            # Stiffness of which the change of slope that is seen would be usual.
            seen = np.diff(slope, prepend=slope[0]) ** 2 / np.maximum(step, 1e-9)
            again = np.where(seen > BREAKS**2 * usual, seen, usual)
            if np.array_equal(again, stiffness):
                break
            stiffness = again
    return best if breaks * LEG <= step.size else best._replace(likelihood=-np.inf)
