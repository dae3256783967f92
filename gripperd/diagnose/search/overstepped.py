"""A constant that stays at the edge of its tolerance and would leave it."""

from collections.abc import Mapping, Sequence

import numpy as np

from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.fit.rival import Rival, larger
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.found import Found
from gripperd.diagnose.search.needed import without_each
from gripperd.diagnose.search.preference import BORE, at_edge
from gripperd.diagnose.search.price import LEAST_MORE
from gripperd.diagnose.search.rivalry import Contest, Place

KIN = 0.5
"""Share of the gain from which another constant could be the wrong one. [-]"""
FAR: Mapping[str, float] = {
    "muscle.rest_length": 0.05, "muscle.diameter": 0.25, "muscle.braid_angle": 0.25,
}  # fmt: skip
"""Share of a size by which nobody mistakes it with a rule or a protractor: a muscle
sold as 10 mm has a braid of 12 mm, and 296 mm were called 300 mm. [-]"""


def with_overstepped(
    found: Found, best: Contest, listed: Sequence[Candidate]
) -> Contest:
    """Let go of the constant of the muscle that the tolerances hold back most.

    Far above the noise constants take what the effects leave, up to the edge of their
    tolerance: one of them is wrong. One is told and no more, for they stand in for each
    other; none when a wrong one is known already.

    Parameters
    ----------
    found, best
        The search and its outcome.
    listed
        What could be missing.
    """
    problem, here = found.problem, best.best
    if not (problem.is_inflated and here.candidates) or here.fit.point.freed:
        return best
    edge = at_edge(problem, here)
    freed = larger(problem, here, [one for one in listed if one.name in edge])
    freed = [one for one in freed if not _is_far_off(problem, one)]
    most = max((one.evidence - here.evidence for one in freed), default=0.0)
    if most <= LEAST_MORE:
        return best
    kin = [one for one in freed if one.evidence - here.evidence > KIN * most]
    kin.sort(key=lambda rival: -rival.evidence)
    told = next((one for one in kin if BORE in one.names), kin[0])
    others = tuple(rival for rival in kin if rival is not told)
    alike = (*(place.rivals for place in best.places), others)
    pairs = zip(without_each(problem, told), alike, strict=True)
    return Contest(told, tuple(Place(*pair) for pair in pairs))


def _is_far_off(problem: Problem, freed: Rival) -> bool:
    """Whether a size is let go so far that it only bends to the misfit."""
    index = freed.candidates[-1].constant
    assert index is not None
    constant, shift = problem.constants[index], float(freed.fit.point.shifts[index])
    far = FAR.get(constant.path, np.inf)
    return abs(shift * constant.sigma) > far * abs(constant.nominal)
