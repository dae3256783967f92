"""Numbers and lists of a diagnosis as a person reads them."""

from collections.abc import Sequence
from math import floor, inf, log10

from gripperd.diagnose.verdict.key import DIGITS
from gripperd.diagnose.verdict.named import Estimate

UNLIKELY = 1e-99
"""Chance below which its size says nothing any more. [-]"""


def fixed(value: float, std: float) -> str:
    """Write a value no finer than two digits of its standard deviation.

    >>> fixed(18.3142, 0.0937), fixed(0.0937, 0.0937), fixed(224.6, 118.0)
    ('18.314', '0.094', '220')
    """
    if not 0 < std < inf:
        return f"{value:.4g}"
    leading = floor(log10(max(abs(value), std)))
    places = min(1 - floor(log10(std)), DIGITS - 1 - leading)
    # Adding 0 turns what would read as -0 into 0.
    return f"{round(value, places) + 0.0:.{max(places, 0)}f}"


def chance(p_value: float) -> str:
    """Write a p-value: never 0, which no measurement can show.

    >>> chance(3.2e-9), chance(0.0)
    ('3e-09', '< 1e-99')
    """
    return f"< {UNLIKELY:g}" if p_value < UNLIKELY else f"{p_value:.1g}"


def stopped(one: Estimate) -> bool:
    """Whether a bound holds a fitted number: its interval is one-sided then."""
    near = 1e-6 * (one.high - one.low)
    ends = min(one.value - one.low, one.high - one.value)
    return -inf < one.low < one.high < inf and ends <= near


def listed(words: Sequence[str], last: str = "and") -> str:
    """Join words the way a sentence has them.

    >>> listed(["a", "b", "c"], "or")
    'a, b or c'
    """
    if len(words) < 2:
        return "".join(words)
    return f"{', '.join(words[:-1])} {last} {words[-1]}"
