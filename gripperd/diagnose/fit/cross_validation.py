"""How well an explanation foretells each sweep from all the others.

References
----------
.. [1] M. Stone, "Cross-validatory choice and assessment of statistical predictions",
       J. R. Stat. Soc. B 36(2), 111-147, 1974.
"""

from collections.abc import Collection, Iterable

import numpy as np

from gripperd.diagnose.fit.gram import bounded
from gripperd.diagnose.fit.polish import Polished
from gripperd.diagnose.fit.tangent import Tangent
from gripperd.diagnose.residuals.holdout import FEW, within
from gripperd.diagnose.residuals.problem import Problem
from gripperd.model.effect import Signal
from gripperd.model.track import Array

TOLD = 0.1
"""Share of what is known of a number that other sweeps tell at least. [-]"""


def foretold(problem: Problem, fit: Polished) -> Array:
    """Misfit of each block when its sweep takes no part in the fit.

    Constants and amplitudes are fitted anew, linear around the fit; shapes stay.

    Parameters
    ----------
    problem
        The recording and the model.
    fit
        Of everything at once.

    Returns
    -------
    Chi² of every block, in their order, shape ``(blocks,)``. [-]
    """
    tangent = Tangent.at(problem, fit)
    here = tangent.here
    low, high = (
        np.where(tangent.shapes, here, bound) for bound in (tangent.low, tangent.high)
    )
    parts = list(zip(tangent.columns, tangent.targets, strict=True))
    # Other sweeps are all but this one: what a sweep adds is taken from the whole.
    products, moments = _normal(parts, here.size)
    owners = np.array([block.course for block in problem.blocks])
    found = np.empty(len(parts))
    for owner in np.unique(owners):
        own = np.flatnonzero(owners == owner)
        of_own = _normal([parts[i] for i in own], here.size)
        told, aimed = products - of_own[0], moments - of_own[1]
        # What shows in this sweep alone the others cannot tell: it stays as it is.
        known = np.diag(told) >= TOLD * np.diag(products)
        reach = np.where(known, low, here), np.where(known, high, here)
        aim = bounded(told + np.eye(here.size), aimed, *reach, here)
        for i in own:
            z, y = parts[i]
            left = y - z @ aim
            found[i] = left @ left
    return found


def _normal(parts: Iterable[tuple[Array, Array]], size: int) -> tuple[Array, Array]:
    """Sum the normal equations of some columns with their targets."""
    products, moments = np.zeros((size, size)), np.zeros(size)
    for z, y in parts:
        products += z.T @ z
        moments += z.T @ y
    return products, moments


def bears_out(
    problem: Problem, smaller: Polished, larger: Polished, signals: Collection[Signal]
) -> bool:
    """Whether sweeps that take no part are foretold better in some signals.

    Those count that lie within what the others cover; with too few of them nothing
    speaks against it.
    """
    blocks = problem.blocks
    owners = np.array([block.course for block in blocks])
    taking_part = np.unique(owners)
    courses = [problem.courses[owner] for owner in taking_part]
    inner = taking_part[within(courses)]
    heard = np.isin(owners, inner) & [block.signal in signals for block in blocks]
    if len(inner) < FEW:
        return True
    gains = foretold(problem, smaller) - foretold(problem, larger)
    return float(gains[heard].sum()) > 0
