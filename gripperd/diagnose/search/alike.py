"""Whether all sweeps come to rest alike: signs of their own hide what goes with time.

Most rigs come to every length from the same side. Where one sweep seems to rest the
other way, it may be the first inflation, or the last of a muscle that tires.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.found import Found
from gripperd.diagnose.search.resting import DECIDED

TURNED = 0.8
"""Part of a sign of its own, of -1 to 1, by which a sweep rests the other way: of 312
recordings of thirteen rigs that hide no physics, 4 had as much. [-]"""
NONE = 1e-3
"""What a sweep keeps of it where all rest alike, of what it may have. [-]"""


def with_rests_alike(found: Found, searched: Callable[[Problem], Found]) -> Found:
    """Give the search in which no sweep has a sign of its own, if it explains more.

    Asked where a sweep rests the other way: that explains it as well as anything until
    something fits better by :data:`~gripperd.diagnose.search.resting.DECIDED`.

    Parameters
    ----------
    found
        The search, with the problem as it was searched.
    searched
        Searches a problem as that was.
    """
    problem, here = found.problem, found.best
    own = _own(problem)
    if problem.is_inflated or not _is_turned(problem, here.fit.point, own):
        return found
    alike = tuple(
        replace(one, sigma=NONE * one.sigma) if is_own else one
        for one, is_own in zip(problem.constants, own, strict=True)
    )
    other = searched(replace(problem, constants=alike))
    # Each search has noise of its own where that is as loud as the misfit.
    if other.problem.is_inflated:
        return found
    return other if other.best.evidence > here.evidence + DECIDED else found


def _own(problem: Problem) -> npt.NDArray[np.bool_]:
    """Which constants are the sign of a sweep that is searched, and of no other."""
    searched = {block.course for block in problem.blocks}
    return np.array([one.course in searched for one in problem.constants])


def _is_turned(problem: Problem, point: Point, own: npt.NDArray[np.bool_]) -> bool:
    usual = replace(point, shifts=np.where(own, 0.0, point.shifts))
    with_own, without = (problem.explanation(one).rests for one in (point, usual))
    return any(abs(sign - without[name]) > TURNED for name, sign in with_own.items())
