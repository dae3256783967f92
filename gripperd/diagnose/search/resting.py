"""Sign of dry friction in sweeps without travel: which convention the data support.

At rest the friction of eq. (7) is set-valued, and a rig may have come to rest either
way. A wrong sign would look like an effect.

References
----------
.. [1] R. A. Serway, J. W. Jewett, "Physics for Scientists and Engineers", 9th ed.,
       Cengage, 2014, table 5.1: coefficients of friction at rest and sliding.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.fit.design import design
from gripperd.diagnose.fit.polish import polished
from gripperd.diagnose.fit.rival import Rival
from gripperd.diagnose.residuals.explanation import AtRest
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.found import Found
from gripperd.diagnose.search.rivalry import Contest, Place
from gripperd.model.effect import Signal

DECIDED = 5.0
"""By so much another convention must be better. [nat]"""
TELLING = (
    "coulomb_friction", "pressure_friction", "braid_friction", "pressure_hysteresis",
    "threshold_pressure", "force_sensor_bias", "force_sensor_gain",
)  # fmt: skip
"""What depends on the sign, or could stand in for it."""
STICTION = 0.3
"""By how much more friction holds what rests than what slides, at most: steel on steel,
dry, 0.74 / 0.57; rubber on concrete 1.0 / 0.8 [1]_. [-]"""


def with_resting_sign(problem: Problem, listed: Sequence[Candidate]) -> Problem:
    """Give the problem with the sign at rest that explains most, by evidence."""
    if not _rests(problem):
        return problem
    few = [one for one in listed if one.name in TELLING]
    best, most = problem, -np.inf
    for sign in AtRest:
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


def with_stiction(found: Found, best: Contest) -> tuple[Found, Contest]:
    """Let friction that was found hold what rests better than what slides.

    Not before it is found: what every sweep at rest is held by is so free then that it
    could stand in for what is missing.

    Parameters
    ----------
    found, best
        The search and its outcome; only how they fit may change.
    """
    rubs = any(one.effect and one.effect.travels for one in best.best.candidates)
    if not rubs or not _rests(found.problem):
        return found, best
    model = replace(found.problem.model, stiction=STICTION)
    problem = replace(found.problem, model=model)

    def again(rival: Rival) -> Rival:
        return replace(rival, fit=polished(problem, rival.fit.point))

    told = again(best.best)
    if best.best.fit.cost - told.fit.cost < 2 * DECIDED:
        return found, best
    places = tuple(
        Place(again(place.without), tuple(again(one) for one in place.rivals))
        for place in best.places
    )
    held = replace(found, problem=problem, null=again(found.null))
    return held, Contest(told, places)


def _rests(problem: Problem) -> bool:
    return any(
        not problem.courses[block.course].direction.any()
        for block in problem.blocks
        if block.signal is Signal.FORCE
    )
