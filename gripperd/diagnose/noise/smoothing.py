"""Inputs without their noise: a local linear trend, as stiff as the noise allows.

References
----------
.. [1] J. Durbin, S. J. Koopman, "Time Series Analysis by State Space Methods", 2nd
       ed., Oxford, 2012, section 3.2.1 (local linear trend) and 4.4 (smoother).
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gripperd.model.compiled import compiled
from gripperd.model.track import Array

STIFFNESSES = 10.0 ** np.arange(-8.0, 5.0)
"""Spectral densities of the slope tried, in units of ``noise² / s³``."""
LEAP = 5.0
"""Standard deviations from what was foreseen at which a column may have leapt. [-]"""
RARE = 5.0
"""What a leap costs: there is none in 149 samples of 150. [nat]"""
SELDOM = 0.05
"""Share of leaps above which a column does not leap, it is quieter than told. [-]"""


class Smooth(NamedTuple):
    """A column without its noise, shape ``(n,)`` each."""

    value: Array
    rate: Array
    """Its time derivative, per second."""
    likelihood: float = -np.inf
    """Log density of the column, up to a constant. [nat]"""
    variance: float = 0.0
    """Of the noise that was taken off, as :func:`smooth` was told."""
    spread: float = 0.0
    """Standard deviation of the value amid the column, as the past alone has it."""
    leapt: tuple[slice, ...] = ()
    """Rows of samples to which it leapt, one after the other."""


def smooth(
    time: Array,
    column: Array,
    variance: float,
    supple: float = 1.0,
    leap: float = np.inf,
) -> Smooth:
    """Take the noise off one column of one run.

    Parameters
    ----------
    time
        Rising, shape ``(n,)``. [s]
    column
        What was measured; NaN is bridged.
    variance
        Of the noise as a mean over many samples sees it: the white variance times
        ``(1 + rho) / (1 - rho)``. The trend is as stiff as its likelihood allows.
    supple
        How much less stiff it shall be, so that corners stay sharp.
    leap
        Standard deviations from which it may leap, and be as stiff on either side.
    """
    if variance <= 0 or column.size < 3 or not np.isfinite(column).any():
        rate = np.gradient(column, time) if column.size > 1 else np.zeros_like(column)
        return Smooth(column, rate)
    scale = np.sqrt(variance)
    scaled = (column - np.nanmean(column)) / scale
    step = np.diff(time, prepend=time[0])
    likelihoods = [compiled(_filter)(scaled, step, q, leap)[0] for q in STIFFNESSES]
    best = STIFFNESSES[int(np.argmax(likelihoods))] * supple
    _, states, spreads, leaps = compiled(_filter)(scaled, step, best, leap)
    level, slope = compiled(_smoother)(states, spreads, step, best, leaps)
    rows = _rows(leaps > 0)
    return Smooth(
        level * scale + np.nanmean(column),
        _with_travel(slope, level, time, rows) * scale,
        max(likelihoods) if np.mean(leaps > 0) < SELDOM else -np.inf,
        variance,
        float(np.sqrt(np.median(spreads[:, 0]))) * float(scale),
        rows,
    )


def _with_travel(
    slope: Array, level: Array, time: Array, leapt: Sequence[slice]
) -> Array:
    """Slope that knows of leaps one way in a row: they are a way, at a rate."""
    found = slope.copy()
    for row in leapt:
        way = slice(row.start - 1, row.stop)
        if row.stop - row.start > 1 and np.ptp(np.sign(np.diff(level[way]))) == 0:
            found[row] = np.gradient(level[way], time[way])[1:]
    return found


def _rows(found: NDArray[np.bool_]) -> tuple[slice, ...]:
    ends = np.flatnonzero(np.diff(found, prepend=False, append=False))
    return tuple(slice(*pair) for pair in ends.reshape(-1, 2).tolist())


def _filter(
    column: Array, step: Array, q: float, leap: float
) -> tuple[float, Array, Array, Array]:
    """Kalman filter: log likelihood, filtered states (n, 2), covariances (n, 3).

    And what leaps added to the variance of the level, (n,).
    """
    n = column.size
    states = np.empty((n, 2))
    spreads = np.empty((n, 3))
    leaps = np.zeros(n)
    level, slope = 0.0, 0.0
    a, b, c = 1e6, 0.0, 1e6
    likelihood = 0.0
    for i in range(n):
        dt = step[i]
        level = level + dt * slope
        a = a + 2 * dt * b + dt * dt * c + q * dt**3 / 3
        b = b + dt * c + q * dt * dt / 2
        c = c + q * dt
        if np.isfinite(column[i]):
            innovation = column[i] - level
            if i > 0 and innovation * innovation > leap * leap * (a + 1.0):
                leaps[i] = innovation * innovation
                likelihood -= RARE
                a += leaps[i]
            variance = a + 1.0
            gain, drag = a / variance, b / variance
            level += gain * innovation
            slope += drag * innovation
            c -= drag * b
            b -= drag * a
            a -= gain * a
            likelihood -= 0.5 * (np.log(variance) + innovation * innovation / variance)
        states[i, 0], states[i, 1] = level, slope
        spreads[i, 0], spreads[i, 1], spreads[i, 2] = a, b, c
    return likelihood, states, spreads, leaps


def _smoother(
    states: Array, spreads: Array, step: Array, q: float, leaps: Array
) -> tuple[Array, Array]:
    """Rauch-Tung-Striebel pass backwards: level and slope."""
    n = step.size
    level = states[:, 0].copy()
    slope = states[:, 1].copy()
    for i in range(n - 2, -1, -1):
        dt = step[i + 1]
        a, b, c = spreads[i, 0], spreads[i, 1], spreads[i, 2]
        # Predicted covariance of the next state, and the gain P F' / predicted.
        pa = a + 2 * dt * b + dt * dt * c + q * dt**3 / 3 + leaps[i + 1]
        pb = b + dt * c + q * dt * dt / 2
        pc = c + q * dt
        determinant = pa * pc - pb * pb
        if determinant <= 0:
            continue
        fa, fb = a + dt * b, b
        ga, gb = b + dt * c, c
        k11 = (fa * pc - fb * pb) / determinant
        k12 = (fb * pa - fa * pb) / determinant
        k21 = (ga * pc - gb * pb) / determinant
        k22 = (gb * pa - ga * pb) / determinant
        ahead = level[i + 1] - (states[i, 0] + dt * states[i, 1])
        bend = slope[i + 1] - states[i, 1]
        level[i] = states[i, 0] + k11 * ahead + k12 * bend
        slope[i] = states[i, 1] + k21 * ahead + k22 * bend
    return level, slope
