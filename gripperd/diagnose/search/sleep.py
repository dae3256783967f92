"""A regulator that sleeps: within its dead band the pressure is anywhere."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.fit.polish import polished
from gripperd.diagnose.fit.rival import Rival, larger
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.resting import DECIDED
from gripperd.model.effect import Signal

SLEEPS, WIDTH = "valve_dead_band", "width"
"""What a band is named by, and what tells how wide it is."""


def with_sleep(problem: Problem, listed: Sequence[Candidate]) -> Problem:
    """Give the problem with the band within which its regulator sleeps, if it does.

    Where on a stair a pressure rests no model foretells for long. All that a dead band
    says is how far from its command that may be, and nothing within it is held against
    an explanation.

    Parameters
    ----------
    problem
        Before the search.
    listed
        What could be missing.
    """
    bands = [one for one in listed if one.name == SLEEPS]
    stepped = any(course.on_stairs for course in problem.courses)
    if not bands or not stepped or Signal.PRESSURE not in problem.signals:
        return problem
    alone = Rival((), polished(problem, Point(np.zeros(len(problem.constants)))))
    beside = max(larger(problem, alone, bands), key=lambda rival: rival.evidence)
    (effect,) = beside.fit.point.effects
    asleep = replace(problem, band=float(getattr(effect, WIDTH)))
    null, told = (polished(asleep, one.fit.point) for one in (alone, beside))
    gained = replace(beside, fit=told).evidence - replace(alone, fit=null).evidence
    return asleep if gained > DECIDED else problem
