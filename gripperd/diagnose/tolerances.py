"""Tolerances that are stated too tight: several constants at once lie beyond theirs."""

from collections.abc import Sequence
from dataclasses import replace

from gripperd.diagnose.candidates import WRONG, Candidate
from gripperd.diagnose.constants import PARTS
from gripperd.diagnose.design import design
from gripperd.diagnose.found import Found
from gripperd.diagnose.polish import polished
from gripperd.diagnose.problem import Problem
from gripperd.diagnose.rival import Rival, added
from gripperd.diagnose.rivalry import Contest, contest

SEVERAL = 2
"""Constants beyond their tolerance that speak of the tolerances, not of one part."""


def with_wider_tolerances(
    found: Found, best: Contest, listed: Sequence[Candidate]
) -> Contest:
    """Let constants alone explain what effects do, if they do it better.

    Held by tolerances that are too tight, constants leave a misfit that any effect of
    a similar form takes up. Freed one after the other they leave none.

    Parameters
    ----------
    found, best
        The search and its outcome.
    listed
        What could be missing.
    """
    wrong = _stated(found.problem)
    if found.problem.is_hot or not best.best.candidates or not wrong:
        return best
    rival = _freed(found, wrong)
    if len(rival.candidates) < SEVERAL or rival.evidence <= best.best.evidence:
        return best
    return contest(replace(found, best=rival), listed)


def _stated(problem: Problem) -> list[Candidate]:
    return [
        Candidate(WRONG + constant.path, None, index)
        for index, constant in enumerate(problem.constants)
        if constant.stated and constant.path.partition(".")[0] in PARTS
    ]


def _freed(found: Found, wrong: Sequence[Candidate]) -> Rival:
    """Free one constant after the other, for as long as it is no chance."""
    problem, rival = found.problem, found.null
    while True:
        left = [one for one in wrong if one not in rival.candidates]
        around = design(problem, rival.fit.point, left)
        gains = {one: around.fit(one).evidence for one in around.members}
        leader = max(gains, key=lambda one: gains[one], default=None)
        base = around.fit().evidence
        if leader is None or gains[leader] - base <= found.threshold:
            return rival
        rival = Rival(
            (*rival.candidates, leader.candidate),
            polished(problem, added(rival.fit.point, leader.candidate)),
        )
