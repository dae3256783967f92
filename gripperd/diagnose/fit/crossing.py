"""How well an explanation foretells each sweep from all the others.

References
----------
.. [1] M. Stone, "Cross-validatory choice and assessment of statistical predictions",
       J. R. Stat. Soc. B 36(2), 111-147, 1974.
"""

from collections.abc import Collection

import numpy as np

from gripperd.diagnose.fit.gram import bounded
from gripperd.diagnose.fit.polish import Polished
from gripperd.diagnose.fit.tangent import Tangent
from gripperd.diagnose.residuals.holdout import FEW, inside
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
    products = np.array([z.T @ z for z, _ in parts])
    moments = np.array([z.T @ y for z, y in parts])
    whole = np.diag(products.sum(0))
    owners = np.array([block.course for block in problem.blocks])
    found = np.empty(len(parts))
    for owner in np.unique(owners):
        own, others = np.flatnonzero(owners == owner), owners != owner
        told = products[others].sum(0)
        # What shows in this sweep alone the others cannot tell: it stays as it is.
        known = np.diag(told) >= TOLD * whole
        reach = np.where(known, low, here), np.where(known, high, here)
        matrix = told + np.eye(here.size)
        aim = bounded(matrix, moments[others].sum(0), *reach, here)
        for i in own:
            z, y = parts[i]
            left = y - z @ aim
            found[i] = left @ left
    return found


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
    inner = [owner for place, owner in enumerate(taking_part) if inside(courses, place)]
    heard = np.isin(owners, inner) & [block.signal in signals for block in blocks]
    if len(inner) < FEW:
        return True
    gains = foretold(problem, smaller) - foretold(problem, larger)
    return float(gains[heard].sum()) > 0
