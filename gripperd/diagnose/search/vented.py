"""A regulator that vents when it is asked for nothing, whatever its line."""

from dataclasses import replace

from gripperd.diagnose.fit.polish import polished
from gripperd.diagnose.fit.rival import Rival, removed
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.found import Found
from gripperd.diagnose.search.resting import DECIDED

OFFSET, SIZE, ZERO, SUPPRESSED = "valve_offset", "offset", "zero", "suppressed"
"""Effect that a line is named by which is off, and what it says of it."""
LINE = "valve.pressure_low"
"""Constant that is off as much."""


def with_vented_zero(found: Found) -> Problem:
    """Give the problem with a regulator that vents below its line, if it does.

    How far a line is off within its tolerance is no effect. A constant that is off
    shows at zero as well, where such a regulator vents, and so the effect is found in
    its place.

    Parameters
    ----------
    found
        The search, with the problem as it was searched.
    """
    problem, here = found.problem, found.best
    effects = {one.name: one for one in here.fit.point.effects}
    line = next((one for one in problem.constants if one.path == LINE), None)
    regulator, offset = problem.model.regulator, effects.get(OFFSET)
    if line is None or regulator is None or offset is None:
        return problem
    within = abs(getattr(offset, SIZE)) < line.reach * line.sigma
    if getattr(offset, ZERO) != SUPPRESSED or not within:
        return problem
    own = next(one for one in here.candidates if one.name == OFFSET)
    others = tuple(one for one in here.candidates if one is not own)
    vents = replace(problem.model, vents=regulator.pressure_low)
    tried = replace(problem, model=vents)
    told = Rival(others, polished(tried, removed(problem, here.fit.point, own)))
    return tried if told.evidence > here.evidence - DECIDED else problem
