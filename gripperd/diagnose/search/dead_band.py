"""A regulator that sleeps in its dead band: within it the pressure is anywhere."""

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

DEAD_BAND, WIDTH = "valve_dead_band", "width"
"""Effect that a band is named by, and its parameter that tells how wide it is."""
FORETOLD = "wakes"
"""Its form that goes in stairs itself."""


def with_dead_band(problem: Problem, listed: Sequence[Candidate]) -> Problem:
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

    Returns
    -------
    The problem with its band [Pa], or as it came if it explains less that way.
    """
    # One that wakes foretells each stair: how wide the band is the middle has to tell.
    bands = [
        one for one in listed if one.name == DEAD_BAND and FORETOLD not in one.kind
    ]
    stepped = any(course.on_stairs for course in problem.courses)
    if not bands or not stepped or Signal.PRESSURE not in problem.signals:
        return problem
    alone = Rival((), polished(problem, Point(np.zeros(len(problem.constants)))))
    beside = max(larger(problem, alone, bands), key=lambda rival: rival.evidence)
    (effect,) = beside.fit.point.effects
    within = replace(problem, band=float(getattr(effect, WIDTH)))
    null, told = (polished(within, one.fit.point) for one in (alone, beside))
    gained = replace(beside, fit=told).evidence - replace(alone, fit=null).evidence
    return within if gained > DECIDED else problem
