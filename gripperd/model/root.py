"""Root of a function of one value.

scipy has better ones, but the control process would spend 40 MB on loading it.
"""

from collections.abc import Callable

PRECISION = 1e-13
"""Relative to the first bracket."""
STEPS = 100
"""Far beyond what a smooth function takes, about 8."""


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
