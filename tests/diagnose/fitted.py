"""Explanations fitted in full, and searches that ended with one of them."""

import numpy as np

from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.fit.polish import polished
from gripperd.diagnose.fit.rival import Rival, added
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.found import Found


def fitted(problem: Problem, *candidates: Candidate) -> Rival:
    """The model with these, from its nominal constants on."""
    point = Point(np.zeros(len(problem.constants)))
    for one in candidates:
        point = added(point, one)
    return Rival(candidates, polished(problem, point))


def ended(problem: Problem, best: Rival, threshold: float = 5.0) -> Found:
    """A search that ended with this, and heard nothing else."""
    null = fitted(problem)
    return Found(problem, null, best, (null, best), threshold, {}, (), np.empty(0))
