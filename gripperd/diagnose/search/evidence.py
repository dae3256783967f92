"""Evidence of a way to read a recording: before anything that is missing is known."""

from collections.abc import Sequence

import numpy as np

from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.fit.design import design
from gripperd.diagnose.fit.polish import polished
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem


def evidence(problem: Problem, few: Sequence[Candidate]) -> float:
    """Of the best constants, with nothing added or one of a few that depend on it.

    Parameters
    ----------
    problem
        Read in one way.
    few
        What depends on the way, or could stand in for another.
    """
    start = polished(problem, Point(np.zeros(len(problem.constants)))).point
    around = design(problem, start, few)
    members = [around.fit(one) for one in around.members]
    return max(fit.evidence for fit in (around.fit(), *members))
