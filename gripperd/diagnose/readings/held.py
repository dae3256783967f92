"""The longest stretch of a sweep in which all that matters is held."""

import numpy as np

from gripperd.model.compiled import compiled
from gripperd.model.track import Array


def longest_held(columns: Array) -> slice:
    """Longest of the stretches in which every column stays within 1, one by one.

    Parameters
    ----------
    columns
        Over the range within which each is held, shape ``(k, n)``. [-]
    """
    start, stop = compiled(_longest)(columns)
    return slice(start, stop)


def _longest(columns: Array) -> tuple[int, int]:
    best, until, start = 0, 0, 0
    low, high = columns[:, 0].copy(), columns[:, 0].copy()
    for i in range(columns.shape[1]):
        low, high = np.minimum(low, columns[:, i]), np.maximum(high, columns[:, i])
        if np.any(high - low > 1.0):
            start = i
            low, high = columns[:, i].copy(), columns[:, i].copy()
        if i + 1 - start > until - best:
            best, until = start, i + 1
    return best, until
