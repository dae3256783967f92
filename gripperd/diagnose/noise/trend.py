"""The trend of a column, walked sample by sample: compiled.

References
----------
.. [1] J. Durbin, S. J. Koopman, "Time Series Analysis by State Space Methods", 2nd
       ed., Oxford, 2012, section 3.2.1 (local linear trend) and 4.4 (smoother).
.. [2] G. D. Forney, "The Viterbi algorithm", Proc. IEEE 61(3), 268-278, 1973.
"""

import numpy as np
from numpy.typing import NDArray

from gripperd.model.track import Array

RARE = 5.0
"""What a leap costs: there is none in 149 samples of 150. [nat]"""


def filtered(
    column: Array, step: Array, stiffness: Array, leap: float, fast: float
) -> tuple[Array, Array, Array, Array]:
    """Kalman filter: log density of each sample, states (n, 2), covariances (n, 3).

    And what leaps added to the variance of the level, (n,). The slope begins at 0, give
    or take ``fast``.
    """
    n = column.size
    states = np.empty((n, 2))
    spreads = np.empty((n, 3))
    leaps = np.zeros(n)
    level, slope = 0.0, 0.0
    a, b, c = 1e6, 0.0, fast * fast
    density = np.zeros(n)
    for i in range(n):
        dt, q = step[i], stiffness[i]
        level = level + dt * slope
        a = a + 2 * dt * b + dt * dt * c + q * dt**3 / 3
        b = b + dt * c + q * dt * dt / 2
        c = c + q * dt
        if np.isfinite(column[i]):
            innovation = column[i] - level
            if i > 0 and innovation * innovation > leap * leap * (a + 1.0):
                leaps[i] = innovation * innovation
                density[i] -= RARE
                a += leaps[i]
            variance = a + 1.0
            gain, drag = a / variance, b / variance
            level += gain * innovation
            slope += drag * innovation
            c -= drag * b
            b -= drag * a
            a -= gain * a
            density[i] -= 0.5 * (np.log(variance) + innovation * innovation / variance)
        states[i, 0], states[i, 1] = level, slope
        spreads[i, 0], spreads[i, 1], spreads[i, 2] = a, b, c
    return density, states, spreads, leaps


def cheapest(densities: Array, cost: float) -> NDArray[np.int64]:
    """Which of several laws rules each sample, when a change costs so much [2]_.

    Densities of shape ``(laws, n)`` and cost in nat.
    """
    laws, n = densities.shape
    came = np.empty((n, laws), np.int64)
    total = densities[:, 0].copy()
    for i in range(1, n):
        leader = np.argmax(total)
        least = total[leader] - cost
        for law in range(laws):
            came[i, law] = law
            if total[law] < least:
                total[law] = least
                came[i, law] = leader
            total[law] += densities[law, i]
    path = np.empty(n, np.int64)
    path[n - 1] = np.argmax(total)
    for i in range(n - 1, 0, -1):
        path[i - 1] = came[i, path[i]]
    return path


def smoothed(
    states: Array, spreads: Array, step: Array, stiffness: Array, leaps: Array
) -> tuple[Array, Array, Array]:
    """Rauch-Tung-Striebel pass backwards: level, slope and variance of the level."""
    n = step.size
    level = states[:, 0].copy()
    slope = states[:, 1].copy()
    a, b, c = spreads[n - 1, 0], spreads[n - 1, 1], spreads[n - 1, 2]
    variance = np.full(n, a)
    for i in range(n - 2, -1, -1):
        dt, q = step[i + 1], stiffness[i + 1]
        after = a, b, c
        a, b, c = spreads[i, 0], spreads[i, 1], spreads[i, 2]
        # Predicted covariance of the next state, and the gain P F' / predicted.
        pa = a + 2 * dt * b + dt * dt * c + q * dt**3 / 3 + leaps[i + 1]
        pb = b + dt * c + q * dt * dt / 2
        pc = c + q * dt
        determinant = pa * pc - pb * pb
        if determinant <= 0:
            variance[i] = a
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
        da, db, dc = after[0] - pa, after[1] - pb, after[2] - pc
        a, b, c = (
            a + k11 * k11 * da + 2 * k11 * k12 * db + k12 * k12 * dc,
            b + k11 * k21 * da + (k11 * k22 + k12 * k21) * db + k12 * k22 * dc,
            c + k21 * k21 * da + 2 * k21 * k22 * db + k22 * k22 * dc,
        )
        variance[i] = a
    return level, slope, variance
