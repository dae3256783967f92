"""Sign of dry friction where nothing travels: which convention the data support.

At rest the friction of eq. (7) is set-valued, and a rig may have come to rest either
way. A wrong sign would look like an effect.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import product

import numpy as np

from gripperd.diagnose.fit.candidates import WRONG, Candidate
from gripperd.diagnose.fit.design import design
from gripperd.diagnose.fit.polish import polished
from gripperd.diagnose.fit.rival import Rival, larger, removed
from gripperd.diagnose.residuals.explanation import AtRest
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.residuals.stages import BRAIDED
from gripperd.diagnose.residuals.track import TURNED
from gripperd.diagnose.search.found import Found
from gripperd.diagnose.search.stepwise import NEXT, additions
from gripperd.diagnose.side_by_side import side_by_side
from gripperd.model.effect import Signal

DECIDED = 5.0
"""By so much another convention must be better. [nat]"""
WINDINGS = (1e-4, 1.4e-4, 2e-4, 2.8e-4, 4e-4, 5.7e-4, 8e-4)
"""Ways tried by which a frame must yield for friction to turn half round. [-]"""
FADINGS = (0.1, 0.4, 1.6, 6.4, 26.0)
"""Times tried in which friction fades at rest: at once, or as rubber gives in. [s]"""
WORTH = 20.0
"""By so much less another may explain after a first step, and be fitted. [nat]"""
BRAID = WRONG + "muscle.friction_coefficient"
STAND_INS = (BRAID, "pressure_hysteresis")
"""What may be found instead of a sign."""
MOUNT = "series_compliance"
TELLING = (
    "coulomb_friction", "pressure_friction", "braid_friction", "pressure_hysteresis",
    "threshold_pressure", "force_sensor_bias", "force_sensor_gain", MOUNT,
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
    rubs = any(
        one.turns == "contraction"
        for one in problem.model.effects
        if one.name != BRAIDED
    )
    others = list(_others(problem, rubs=rubs))
    most, *supports = side_by_side(
        lambda tried: _evidence(replace(tried, processes=1), few),
        (problem, *others),
        problem.processes,
    )
    best = problem
    for tried, told in zip(others, supports, strict=True):
        if told > most + _lead(best, tried):
            best, most = tried, told
    return best


def _evidence(problem: Problem, few: Sequence[Candidate]) -> float:
    """Of the best constants, with nothing added or one of a few. [nat].

    What gives in a mount turns friction round as well, which no slope of its size
    tells: it is fitted in full.
    """
    bare = Rival((), polished(problem, Point(np.zeros(len(problem.constants)))))
    around = design(problem, bare.fit.point, few)
    told = {one.candidate: around.fit(one).evidence for one in around.members}
    mounts = [one for one in told if one.name == MOUNT]
    likely = sorted(mounts, key=told.__getitem__, reverse=True)[:1]
    full = [one.evidence for one in larger(problem, bare, likely)]
    return max((around.fit().evidence, *told.values(), *full))


def _lead(best: Problem, tried: Problem) -> float:
    """By how much another sign must be better; by none if but its way or time is."""
    winds = best.model.winding and tried.model.winding
    fades = best.model.fading and tried.model.fading
    return 0.0 if winds or fades else DECIDED


def _others(problem: Problem, *, rubs: bool) -> Iterator[Problem]:
    """Give the problem with every other sign.

    Only what rubs beside the bladder has one that is not that of the bladder, and what
    a frame that yields holds is not carried.
    """
    model = problem.model
    yields = any(course.yields for course in problem.courses)
    for sign in TURNED if yields else AtRest:
        if sign is model.at_rest and not model.fading:
            continue
        if rubs or sign is not AtRest.BLADDER:
            held = replace(model, at_rest=sign, winding=0.0, fading=0.0)
            yield replace(problem, model=held)
    for winding in WINDINGS if yields else ():
        if winding != model.winding:
            yield replace(problem, model=replace(model, winding=winding, fading=0.0))


def _fading(problem: Problem) -> Iterator[Problem]:
    """Give the problem with friction that fades at rest, as fast as it may.

    Whether it turns with the pressure before it does or not. It is asked beside what
    was found alone: what creeps fast looks alike.
    """
    model = problem.model
    for sign, fading in product((AtRest.CARRIED, AtRest.INFLATING), FADINGS):
        if (sign, fading) != (model.at_rest, model.fading):
            tried = replace(model, at_rest=sign, winding=0.0, fading=fading)
            yield replace(problem, model=tried)


def with_sign_beside(
    found: Found, listed: Sequence[Candidate], searched: Callable[[Problem], Found]
) -> Found:
    """Give the search with another sign at rest, if it fits better beside the found.

    What nobody knew of when the sign was chosen may have stood behind it: a cell that
    is late opens the loop of a friction that turns with the pressure. With the wrong
    sign more names than are true may fit as well: where some depend on it, the next
    best is searched anew, and taken if fewer explain as much.

    Parameters
    ----------
    found
        The search, with the problem as it was searched.
    listed
        What could be missing.
    searched
        Searches a problem as that was.
    """
    problem, here = found.problem, found.best
    if not here.candidates or not rests(problem):
        return found
    others = [*_others(problem, rubs=True), *_fading(problem)]
    supports = side_by_side(
        lambda tried: _support(found, replace(tried, processes=1), listed),
        others,
        problem.processes,
    )
    best, most = problem, here.evidence
    near, nearest, likely = problem, -np.inf, -np.inf
    for tried, (told, bare) in zip(others, supports, strict=True):
        if bare > nearest:
            near, nearest, likely = tried, bare, told
        if told > most + _lead(best, tried):
            best, most = tried, told
    if best is not problem:
        return searched(best)
    depends = not {*here.names}.isdisjoint((*TELLING, BRAID))
    if not depends or likely < here.evidence - DECIDED:
        return found
    other = searched(near)
    return other if _is_simpler(other, found) else found


def _support(
    found: Found, tried: Problem, listed: Sequence[Candidate]
) -> tuple[float, float]:
    """Evidence of the best with another sign, and of it without what stands in for one.

    Beside what stands in for it every sign is alike. A fading that explains much less
    after a first step explains nothing.
    """
    here = found.best
    if tried.model.fading:
        roughly = polished(tried, here.fit.point, rounds=1)
        if replace(here, fit=roughly).evidence <= here.evidence - WORTH:
            return -np.inf, -np.inf
    fits = list(_beside(replace(found, problem=tried), listed))
    fewest = min(len(one.candidates) for one in fits)
    return (
        max(one.evidence for one in fits),
        max(one.evidence for one in fits if len(one.candidates) == fewest),
    )


def _is_simpler(other: Found, found: Found) -> bool:
    """Whether a search explains as much with fewer names."""
    if other.problem.is_inflated or found.problem.is_inflated:
        return False
    fewer = len(other.best.candidates) < len(found.best.candidates)
    return fewer and other.best.evidence >= found.best.evidence


def _beside(found: Found, listed: Sequence[Candidate]) -> Iterator[Rival]:
    """Give the best as it is, and without what may be found instead of a sign.

    A braid that hardly rubs any more takes no notice of its sign, and hides it: then
    with others instead as well.
    """
    problem, here = found.problem, found.best
    yield replace(here, fit=polished(problem, here.fit.point))
    for one in here.candidates:
        if one.name in STAND_INS:
            others = tuple(other for other in here.candidates if other is not one)
            point = removed(problem, here.fit.point, one)
            bare = Rival(others, polished(problem, point))
            yield bare
            if one.name == BRAID:
                yield from additions(found, bare, listed, NEXT)


def rests(problem: Problem) -> bool:
    """Whether the force of any sweep is explained that rests, or amid its travel."""
    pulls = (
        problem.courses[block.course]
        for block in problem.blocks
        if block.signal is Signal.FORCE
    )
    return any(course.halts or not course.direction.any() for course in pulls)
