"""A Prony series: first-order lags in parallel, as dashpots with springs are.

References
----------
.. [1] J. D. Ferry, "Viscoelastic Properties of Polymers", 3rd ed., Wiley, 1980,
       chapter 1: generalised Maxwell element, a series of exponentials.
"""

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from gripperd.model.compiled import compiled

Array: TypeAlias = NDArray[np.float64]

Terms: TypeAlias = tuple[float, float, float]
"""One number for each lag."""


def followed(
    signal: Array, step: Array, times: Terms, shares: Terms, memory: Array
) -> Array:
    r"""Sum of what has followed a signal in each lag.

    .. math:: y = \sum_i a_i u_i, \quad \tau_i \dot u_i = u - u_i

    exact for a signal that is constant between samples.

    Parameters
    ----------
    signal
        What is followed, shape ``(n,)``. A sample of NaN is not known: within a call,
        the one before it holds on.
    step
        Time since the sample before, shape ``(n,)``. [s]
    times, shares
        Time constants [s], and what each lag has of the sum. [-]
    memory
        What has followed so far, shape ``(3,)``; NaN has not begun, and settles at the
        first sample. It is moved on, but for lags without a share.
    """
    terms = np.array([times, shares], dtype=np.float64)
    return compiled(_followed)(signal, step, terms, memory)


def _followed(signal: Array, step: Array, terms: Array, memory: Array) -> Array:
    out = np.zeros_like(signal)
    times, shares = terms
    for place in range(shares.size):
        if shares[place] == 0:
            continue
        last = goal = memory[place]
        for index in range(signal.size):
            if not np.isnan(signal[index]):
                goal = signal[index]
            if np.isnan(last):
                last = goal
            last = goal + (last - goal) * np.exp(-step[index] / times[place])
            out[index] += shares[place] * last
        memory[place] = last
    return out
