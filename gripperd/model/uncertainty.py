"""Uncertainty of what follows from constants that are known only to within a tolerance.

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data: Guide to the expression of
       uncertainty in measurement", BIPM, section 5.2.
"""

from collections.abc import Mapping
from math import hypot, sqrt


def combined(
    changes: Mapping[str, float], correlations: Mapping[tuple[str, str], float]
) -> float:
    r"""Combined standard uncertainty, [1]_ eq. (16).

    .. math:: u^2 = \sum_i u_i^2 + 2 \sum_{i<j} r_{ij} u_i u_j

    Parameters
    ----------
    changes
        :math:`u_i`, signed: what one sigma of each constant changes, by its path.
    correlations
        :math:`r_{ij}` by two paths; 0 of pairs that are not there. Those of constants
        without a change count for nothing. [-]

    Examples
    --------
    >>> combined({"a": 3.0, "b": 4.0}, {})
    5.0
    >>> combined({"a": 3.0, "b": 4.0}, {("a", "b"): -1.0})
    1.0
    """
    independent = hypot(*changes.values())
    shared = sum(
        r * changes[one] * changes[other]
        for (one, other), r in correlations.items()
        if one in changes and other in changes
    )
    # Coefficients that went through a file are rounded: a variance of 0 may end below.
    return sqrt(max(independent**2 + 2 * shared, 0.0))
