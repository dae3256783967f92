"""Friction that was found: the plainest law, and what it holds at rest.

References
----------
.. [1] R. A. Serway, J. W. Jewett, "Physics for Scientists and Engineers", 9th ed.,
       Cengage, 2014, table 5.1: coefficients of friction at rest and sliding.
"""

from dataclasses import replace

from gripperd.diagnose.fit.polish import polished
from gripperd.diagnose.fit.rival import Rival
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.found import Found
from gripperd.diagnose.search.resting import DECIDED, rests
from gripperd.diagnose.search.rivalry import Contest, Place, standing_in
from gripperd.model.effect import Effect
from gripperd.model.parameter import parameters

STICTION = 0.3
"""By how much more friction holds what rests than what slides, at most: steel on steel,
dry, 0.74 / 0.57; rubber on concrete 1.0 / 0.8 [1]_. [-]"""
DRY = frozenset({"coulomb_friction", "pressure_friction", "braid_friction"})


def with_stiction(found: Found, best: Contest) -> Contest:
    """Let friction that was found hold what rests better than what slides.

    Not before it is found: what every sweep at rest is held by is so free then that it
    could stand in for what is missing. A law of friction that takes up what stiction
    does is not believed beside it: of laws that explain as much the plainest is told.

    Parameters
    ----------
    found, best
        The search and its outcome; only how it fits may change, and who fits as well.
    """
    problem = found.problem
    if not DRY & {*best.best.names}:
        return best
    told = _plainest(problem, best.best)
    if rests(problem):
        sticking = _plainest(problem, _held(problem, told))
        if told.fit.cost - sticking.fit.cost >= 2 * DECIDED:
            told = sticking
    if told is best.best:
        return best
    places = tuple(
        Place(
            _alike(problem, place.without, told),
            tuple(_alike(problem, one, told) for one in place.rivals),
        )
        for place in best.places
    )
    return standing_in(found, Contest(told, places))


def _held(problem: Problem, rival: Rival) -> Rival:
    point = replace(rival.fit.point, stiction=STICTION)
    return replace(rival, fit=polished(problem, point))


def _alike(problem: Problem, rival: Rival, told: Rival) -> Rival:
    """Let a rival hold as well what is told is held, if it is a friction as well."""
    sticks = told.fit.point.stiction > 0 and DRY & {*rival.names}
    return _plainest(problem, _held(problem, rival)) if sticks else rival


def _plainest(problem: Problem, rival: Rival) -> Rival:
    """Go back to laws with fewer numbers wherever no other explains more."""
    for effect in rival.fit.point.effects:
        for name, known in parameters(effect).items():
            if known.switches and getattr(effect, name) != 0:
                plain = _plainer(problem, rival, effect, name)
                # One number may be needed only beside another that is not.
                if plain is not rival:
                    return _plainest(problem, plain)
    return rival


def _plainer(problem: Problem, rival: Rival, effect: Effect, name: str) -> Rival:
    (here,) = (one for one in rival.fit.point.effects if one.name == effect.name)
    point = rival.fit.point.changed(replace(here, **{name: 0.0}))
    plain = replace(rival, fit=polished(problem, point))
    return plain if plain.evidence > rival.evidence - DECIDED else rival
