"""Sign of dry friction in sweeps without travel: which convention the data support.

At rest the friction of eq. (7) is set-valued, and a rig may have come to rest either
way. A wrong sign would look like an effect.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from gripperd.diagnose.fit.candidates import WRONG, Candidate
from gripperd.diagnose.fit.design import design
from gripperd.diagnose.fit.polish import polished
from gripperd.diagnose.fit.rival import Rival, removed
from gripperd.diagnose.residuals.explanation import AtRest, Explanation
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.residuals.stages import BRAIDED
from gripperd.diagnose.search.found import Found
from gripperd.diagnose.search.stepwise import NEXT, additions
from gripperd.model.effect import Signal

DECIDED = 5.0
"""By so much another convention must be better. [nat]"""
BRAID = WRONG + "muscle.friction_coefficient"
TELLING = (
    "coulomb_friction", "pressure_friction", "braid_friction", "pressure_hysteresis",
    "threshold_pressure", "force_sensor_bias", "force_sensor_gain",
)  # fmt: skip
"""What depends on the sign, or could stand in for it."""


def with_resting_sign(problem: Problem, listed: Sequence[Candidate]) -> Problem:
    """Give the problem with the sign at rest that explains most, by evidence.

    Parameters
    ----------
    problem
        Before the search; the sign of its model stays where none is better.
    listed
        What could be missing; of it what :data:`TELLING` names is tried beside each.
    """
    if not rests(problem):
        return problem
    few = [one for one in listed if one.name in TELLING]
    best, most = problem, -np.inf
    known = problem.model.at_rest
    others = [sign for sign in _of(problem.model) if sign is not known]
    for sign in (known, *others):
        tried = replace(problem, model=replace(problem.model, at_rest=sign))
        start = polished(tried, Point(np.zeros(len(problem.constants)))).point
        around = design(tried, start, few)
        evidence = max(
            [
                around.fit().evidence,
                *(around.fit(one).evidence for one in around.members),
            ]
        )
        if evidence > most + DECIDED:
            best, most = tried, evidence
    return best


def _of(model: Explanation) -> list[AtRest]:
    """Signs that are another for a model: only what rubs besides has one of its own."""
    rubs = any(
        one.turns == "contraction" for one in model.effects if one.name != BRAIDED
    )
    return [sign for sign in AtRest if rubs or sign is not AtRest.BLADDER]


def with_sign_beside(found: Found, listed: Sequence[Candidate]) -> Problem:
    """Give the problem with another sign at rest, if it fits better beside the found.

    What nobody knew of when the sign was chosen may have stood behind it: a cell that
    is late opens the loop of a friction that turns with the pressure.

    Parameters
    ----------
    found
        The search, with the problem as it was searched.
    listed
        What could be missing.
    """
    problem, here = found.problem, found.best
    if not here.candidates or not rests(problem):
        return problem
    best, most = problem, here.evidence
    for sign in AtRest:
        if sign is problem.model.at_rest:
            continue
        tried = replace(problem, model=replace(problem.model, at_rest=sign))
        fits = _beside(replace(found, problem=tried), listed)
        if (evidence := max(one.evidence for one in fits)) > most + DECIDED:
            best, most = tried, evidence
    return best


def _beside(found: Found, listed: Sequence[Candidate]) -> Iterator[Rival]:
    """Give the best as it is; where its braid rubs otherwise, with others instead.

    A braid that hardly rubs any more takes no notice of its sign, and hides it.
    """
    problem, here = found.problem, found.best
    yield replace(here, fit=polished(problem, here.fit.point))
    for one in here.candidates:
        if one.name == BRAID:
            others = tuple(other for other in here.candidates if other is not one)
            point = removed(problem, here.fit.point, one)
            bare = Rival(others, polished(problem, point))
            yield from (bare, *additions(found, bare, listed, NEXT))


def rests(problem: Problem) -> bool:
    """Whether the force of any sweep without travel is explained."""
    return any(
        not problem.courses[block.course].direction.any()
        for block in problem.blocks
        if block.signal is Signal.FORCE
    )
