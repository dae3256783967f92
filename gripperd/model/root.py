"""Root of a function of one value, or of many such functions at once.

scipy has better ones, but the control process would spend 40 MB on loading it.
"""

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

PRECISION = 1e-13
"""Relative to the first bracket."""
STEPS = 100
"""Far beyond what a smooth function takes, about 8."""
HALVINGS = 44
"""Of the first bracket, to the same precision: 2 to the -44 is 6e-14."""


def falling_root(function: Callable[[float], float], low: float, high: float) -> float:
    """Where a falling function crosses 0, by false position in the Illinois form.

    Parameters
    ----------
    function
        Not below 0 at `low`, not above 0 at `high`.
    low, high
        The bracket.

    References
    ----------
    .. [1] M. Dowell, P. Jarratt, "A modified regula falsi method for computing the
           root of an equation", BIT 11, 168-174, 1971.

    Examples
    --------
    >>> falling_root(lambda x: 2 - x * x, 0.0, 2.0)
    1.41421356237
    """
    above, below = function(low), function(high)
    width = PRECISION * (high - low)
    side = 0
    for _ in range(STEPS):
        if high - low <= width or above == below:
            break
        point = (low * below - high * above) / (below - above)
        value = function(point)
        if value > 0:
            low, above = point, value
            # The end that stays is weighed less, or it would stay for ever.
            below = below / 2 if side > 0 else below
            side = 1
        elif value < 0:
            high, below = point, value
            above = above / 2 if side < 0 else above
            side = -1
        else:
            return point
    return low if abs(above) < abs(below) else high


def falling_roots(
    function: "Callable[[NDArray[np.float64]], float | NDArray[np.float64]]",
    low: "NDArray[np.float64]",
    high: "NDArray[np.float64]",
) -> "NDArray[np.float64]":
    """Where each of many falling functions crosses 0, by bisection.

    Parameters
    ----------
    function
        All at once: values at points, both of the shape of the bracket.
    low, high
        The brackets, as for :func:`falling_root`.

    Returns
    -------
    The roots; not a number where a function is not.
    """
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        value = function(middle)
        low = np.where(value > 0, middle, low)
        high = np.where(value > 0, high, middle)
    return np.where(np.isnan(function(high)), np.nan, high)
