"""Which of several explanations to believe when misfit, not noise, sets them apart."""

from collections.abc import Collection, Sequence

import numpy as np

from gripperd.diagnose.fit.candidates import WRONG, amplitudes, is_exact
from gripperd.diagnose.fit.design import limits
from gripperd.diagnose.fit.rival import Rival
from gripperd.diagnose.residuals.holdout import FEW
from gripperd.diagnose.residuals.problem import Problem
from gripperd.model.effect import Effect

ALIKE = 1.25
"""Misfit over the least of any rival up to which, far above the noise, a difference
says only that neither formula is that of nature. [-]"""
AMPLE = 1.6
"""The same against a formula that leaves the bore at the edge of its tolerance: of
several numbers, it bends to more than the bore does. [-]"""
BORE = WRONG + "muscle.diameter"
"""The constant that is wrong first: nobody states the diameter of a braid."""
HELD = 0.999
"""Share of a limit from which a number is held back by it. [-]"""


def preferred(problem: Problem, rivals: Sequence[Rival]) -> Rival:
    """Give the likeliest; far above the noise the soundest of those that fit alike.

    Sound is what no limit of physics holds back. Of constants and factors that stand in
    for each other the bore is told: a catalogue has that of the bladder, not of the
    braid. For the same reason it is told before a formula that the bore, held at the
    edge of its tolerance, could replace.

    Parameters
    ----------
    problem
        The recording and the model.
    rivals
        At least one.
    """
    best = max(rivals, key=lambda rival: rival.evidence)
    if not problem.is_inflated or len({one.course for one in problem.blocks}) < FEW:
        return best
    alike = [one for one in rivals if one.fit.cost <= ALIKE * best.fit.cost]
    sound = [one for one in alike if not strained(problem, one)] or [best]
    top = max(sound, key=lambda rival: rival.evidence)
    bored = [one for one in rivals if _has_bore_instead(problem, one, top)]
    return max(bored, key=lambda rival: rival.evidence, default=top)


def _has_bore_instead(problem: Problem, rival: Rival, other: Rival) -> bool:
    """Whether but the bore stands where the other has something it could replace."""
    instead = [one for one in other.candidates if one.name not in rival.names]
    if BORE not in rival.names or len(instead) != 1 or strained(problem, rival):
        return False
    if instead[0].effect is None or is_exact(instead[0]):
        return rival.fit.cost <= ALIKE * other.fit.cost
    return BORE in at_edge(problem, other) and rival.fit.cost <= AMPLE * other.fit.cost


def at_edge(problem: Problem, rival: Rival) -> tuple[str, ...]:
    """Names of the constants of the muscle that their tolerances hold back.

    Parameters
    ----------
    problem
        Whose constants they are.
    rival
        The explanation that was fitted with them.
    """
    point = rival.fit.point
    held = np.abs(point.shifts / point.widths) > HELD * problem.reach(point)
    return tuple(
        WRONG + problem.constants[index].path
        for index in np.flatnonzero(held)
        if problem.constants[index].path.startswith("muscle.")
    )


def strained(problem: Problem, rival: Rival, among: Collection[str] = ()) -> bool:
    """Whether an effect, of some or of all, would be larger, did its limit let it.

    Parameters
    ----------
    problem
        The recording and the model.
    rival
        The explanation that was fitted.
    among
        Names of some of its effects; none for all.
    """
    return any(
        _at_limit(problem, effect, name)
        for effect in rival.fit.point.effects
        if not among or effect.name in among
        for name in amplitudes(effect)
    )


def _at_limit(problem: Problem, effect: Effect, name: str) -> bool:
    value = float(getattr(effect, name))
    return any(
        np.isfinite(bound) and bound * value > 0 and abs(value) >= HELD * abs(bound)
        for bound in limits(problem, effect, name)
    )
