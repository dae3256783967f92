"""Whether the readings bear out the memory of what is named for it."""

from collections.abc import Iterable, Sequence
from dataclasses import replace

from gripperd.diagnose.fit.candidates import Candidate, side, surprise
from gripperd.diagnose.fit.polish import polished
from gripperd.diagnose.fit.rival import Rival
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.curve import beyond_curves
from gripperd.diagnose.side_by_side import side_by_side
from gripperd.model.effect import Effect, Signal

SEEN = 13.0
"""By how much likelier the readings are with a loop than with its curve alone. [nat]"""
OWN = 1 / 3
"""Share of what a loop the wrong way round explains that its curve does not. Friction
takes work; a loop that gives some is the misfit of a curve, or all there is. On rigs of
others loops explained 0.60 at least, and such misfits 0.22 at most. [-]"""
FAR = 100.0
"""Mean square of what every explanation leaves, in squares of the noise, from which no
loop is seen: a curve and a loop at will bend to whatever else is missing. Nor is it
seen what else the rest of the model may mean. [-]"""


def discernible(problem: Problem, listed: Iterable[Candidate]) -> list[Candidate]:
    """Give those that are plain to see, if misfit is too large for others.

    Others are a curve with a loop, and what needs the model to mean something unusual.

    Parameters
    ----------
    problem
        With noise as loud as what every explanation leaves.
    listed
        What could be missing.
    """
    return [
        one
        for one in listed
        if one.effect is None
        or (one.effect.forgetful is one.effect and not surprise(one.effect))
        or problem.inflation({one.effect.signal}) <= FAR
    ]


def show_their_loops(problem: Problem, rivals: Sequence[Rival]) -> list[bool]:
    """Tell of each of some explanations what :func:`shows_its_loop` does."""
    return side_by_side(
        lambda one: shows_its_loop(problem, one), rivals, problem.processes
    )


def shows_its_loop(problem: Problem, rival: Rival) -> bool:
    """Tell whether each of its effects needs the memory that it is named for.

    Relays follow a curve, which may be all that there is, or nearly all where they have
    a loop the wrong way round; or where they bend as no other curve of the library.

    Parameters
    ----------
    problem
        The recording and the model.
    rival
        The explanation that was fitted.
    """
    point = rival.fit.point
    for effect in point.effects:
        bare = effect.forgetful
        if bare is effect:
            continue
        if beyond_curves(problem, point, effect) < SEEN:
            return False
        # The constants may make up for a loop that is in nothing but the fit.
        given = replace(problem, model=problem.model.with_effect(bare))
        others = point.without(effect.name)
        cost = rival.fit.cost
        loop = polished(given, others, enough=cost + 2 * SEEN).cost - cost
        if loop < 2 * SEEN:
            return False
        if side(effect) > 0:
            continue
        alone = polished(problem, others, enough=cost + loop / OWN).cost - cost
        if loop < OWN * alone:
            return False
    return True


def is_but_curve(rival: Rival, other: Rival) -> bool:
    """Tell whether a memory is hardly likelier than what has none in its place.

    A loop, or a force that comes late: a creep that is slower than any sweep is a curve
    of pressure and length.

    Parameters
    ----------
    rival, other
        Explanations that differ in one place.
    """
    own = [one for one in rival.fit.point.effects if one.name not in other.names]
    new = [one for one in other.fit.point.effects if one.name not in rival.names]
    if any(one.turns or one.rest().size for one in new):
        return False
    loops = any(one.forgetful is not one for one in own)
    late = any(_comes_late(one) for one in own) and not any(one.timed for one in new)
    return (loops or late) and rival.evidence - other.evidence < SEEN


def _comes_late(effect: Effect) -> bool:
    late = bool(effect.rest().size) and not (effect.turns or effect.timed)
    return late and effect.signal is Signal.FORCE
