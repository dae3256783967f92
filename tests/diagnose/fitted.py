"""Explanations fitted in full, and searches that ended with one of them."""

import numpy as np

from gripperd.diagnose.candidates import Candidate
from gripperd.diagnose.found import Found
from gripperd.diagnose.point import Point
from gripperd.diagnose.polish import polished
from gripperd.diagnose.problem import Problem
from gripperd.diagnose.rival import Rival, added


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
