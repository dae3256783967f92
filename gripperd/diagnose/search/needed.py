"""What an explanation needs of what it has, once all of it is there."""

from gripperd.diagnose.fit.rival import Rival, fitted, removed
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.bic import STRONG, delta_bic


def needed(
    problem: Problem, told: Rival, without: tuple[Rival, ...], threshold: float
) -> tuple[Rival, tuple[Rival, ...]]:
    """Drop what is idle beside the rest, and give it without each that is not.

    Parameters
    ----------
    problem
        The recording and the model.
    told, without
        An explanation, and it without each of its candidates.
    threshold
        Gain up to which one is idle. [nat]
    """
    while len(told.candidates) > 1:
        idle = [
            bare
            for one, bare in zip(told.candidates, without, strict=True)
            if told.evidence - bare.evidence <= threshold
            or (one.effect and delta_bic(problem, told, bare) > STRONG)
        ]
        if not idle:
            break
        told = max(idle, key=lambda one: one.evidence)
        without = without_each(problem, told)
    return told, without


def without_each(problem: Problem, told: Rival) -> tuple[Rival, ...]:
    """Give it without each of its candidates, fitted anew."""
    starts = [
        (
            (*told.candidates[:index], *told.candidates[index + 1 :]),
            removed(problem, told.fit.point, own),
        )
        for index, own in enumerate(told.candidates)
    ]
    return tuple(fitted(problem, starts))
