"""Holds in which a valve is shut: which way to tell them the data support."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.fit.design import design
from gripperd.diagnose.fit.polish import polished
from gripperd.diagnose.readings.shut import resting, sinking, sinking_faster
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.resting import DECIDED
from gripperd.model.track import Array

SHUT = "leak"
"""What shows only where a valve is shut."""


def with_valve_shut(problem: Problem, listed: Sequence[Candidate]) -> Problem:
    """Give the problem with the holds shut in which a leak explains most.

    Every hold may be, or those alone whose pressure sinks, or sinks faster than in
    others, in which a slow regulator feeds the leak. Where some sink and what the
    others lose does not decide it, a leak fits one way much better.

    Parameters
    ----------
    problem
        Before the search.
    listed
        What could be missing.
    """
    leaks = [one for one in listed if one.name == SHUT]
    sunk = sinking(problem.courses)
    if not leaks or not any(waits.any() for waits in sunk):
        return problem
    start = polished(problem, Point(np.zeros(len(problem.constants)))).point
    best, most = problem, _evidence(problem, start, leaks)
    every = [resting(course) for course in problem.courses]
    for waits in (every, sunk, sinking_faster(problem.courses)):
        tried = _waiting(problem, waits)
        evidence = _evidence(tried, start, leaks)
        if evidence > most + DECIDED:
            best, most = tried, evidence
    return best


def _waiting(problem: Problem, waits: Sequence[Array]) -> Problem:
    courses = [
        replace(course, waiting=wait)
        for course, wait in zip(problem.courses, waits, strict=True)
    ]
    return replace(problem, courses=tuple(courses))


def _evidence(problem: Problem, start: Point, leaks: Sequence[Candidate]) -> float:
    around = design(problem, start, leaks)
    gains = [around.fit(one).evidence for one in around.members]
    return max(gains, default=-np.inf)
