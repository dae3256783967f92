"""Linear Gaussian fits in the space of inner products, where each costs microseconds.

Columns are whitened and scaled by their prior sigma, so with ``G = Z'Z`` and
``b = Z'y`` the best coefficients of a set of columns A are ``(G_AA + 1)^-1 b_A``.

References
----------
.. [1] C. M. Bishop, "Pattern Recognition and Machine Learning", Springer, 2006,
       section 3.5.1: evidence of a linear model.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gripperd.model.track import Array

Indices = NDArray[np.intp]


@dataclass(frozen=True, slots=True)
class Fit:
    """Best coefficients of some columns."""

    columns: Indices
    coefficients: Array
    cost: float
    """Misfit plus prior: chi² at the best. [-]"""
    evidence: float
    """Log of the marginal likelihood, up to what all fits share. [nat]"""


@dataclass(frozen=True, slots=True)
class Gram:
    """Inner products of whitened columns and residual."""

    products: Array
    """Shape ``(m, m)``."""
    moments: Array
    """With the residual, shape ``(m,)``."""
    square: float
    """Of the residual."""
    low: Array
    """Least coefficient that physics or a tolerance allows, shape ``(m,)``."""
    high: Array
    """Largest."""

    def fit(self, columns: Sequence[int] | Indices, start: Array | None = None) -> Fit:
        """Fit some columns.

        A coefficient that would leave its bounds stays on them. Coefficients nearby
        are where to start; none for anywhere.
        """
        kept = np.asarray(columns, dtype=np.intp)
        matrix = self.products[np.ix_(kept, kept)] + np.eye(kept.size)
        moments = self.moments[kept]
        best = bounded(matrix, moments, self.low[kept], self.high[kept], start)
        cost = self.square - float((2 * moments - matrix @ best) @ best)
        volume = float(np.linalg.slogdet(matrix)[1])
        return Fit(kept, best, cost, -0.5 * (cost + volume))


def bounded(
    matrix: Array,
    moments: Array,
    low: Array,
    high: Array,
    start: Array | None = None,
) -> Array:
    """Solve normal equations within bounds: what leaves them most is put on them.

    Parameters
    ----------
    matrix, moments
        Of the normal equations, shapes ``(k, k)`` and ``(k,)``.
    low, high
        Bounds of the solution, shape ``(k,)``.
    start
        A solution nearby: what it has on its bounds is held there at first.
    """
    fixed = low >= high
    best = np.clip(np.zeros_like(moments) if start is None else start, low, high)
    free = ~fixed if start is None else (best > low) & (best < high)
    for _ in range(4 * moments.size):
        loose, held = np.flatnonzero(free), np.flatnonzero(~free)
        rows = loose[:, None]
        rest = moments[loose] - matrix[rows, held] @ best[held]
        best[loose] = np.linalg.solve(matrix[rows, loose], rest)
        over = np.where(free, np.maximum(best - high, low - best), 0.0)
        worst = int(np.argmax(over))
        if over[worst] > 1e-9:
            free[worst] = False
            best[worst] = min(max(best[worst], low[worst]), high[worst])
            continue
        # What the bound no longer holds is let go (Karush-Kuhn-Tucker).
        inward = (moments - matrix @ best) * np.where(best <= low, 1.0, -1.0)
        inward[free | fixed] = 0.0
        worst = int(np.argmax(inward))
        if inward[worst] <= 1e-9:
            break
        free[worst] = True
    return np.clip(best, low, high)
