"""Which explanation is believed: each for as much as others could feign it."""

from collections.abc import Sequence

from gripperd.diagnose.fit.candidates import Candidate, is_plain
from gripperd.diagnose.fit.rival import Rival
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.preference import preferred
from gripperd.diagnose.search.price import worth

LEAST = 13.0
"""Gain below which no model of a rig is known well enough: odds of 4e5. In 96
recordings of six rigs that lacked nothing the most was 10, but for delays that are too
short to be seen. [nat]"""
LEAST_SLOW = 20.0
"""The same of what warmth or the clock tells, as they do a drift, and of a sensor that
drifts or is late: odds of 5e8. In 192 recordings of twelve rigs that lacked nothing,
half of which drift by 0.2 % of full scale, a drift gained 22; in one of a rig more a
first inflation gained 18. [nat]"""
LEAST_BESIDE = 20.0
"""The same beside another effect, whose formula is ours. [nat]"""
LEAST_PLAIN = 8.0
"""The same of an offset or a factor, which little resembles: odds of 3000. [nat]"""
LEAST_WRONG = 2.5
"""The same of one constant: against it stands that all parts are as stated, and no form
that is ours. In 157 recordings of seven rigs in which nothing was found before, and
nothing was hidden, the most was 2.4. [nat]"""
MOST = 4
"""Effects that one recording may add."""


def simplest(
    problem: Problem, null: Rival, rivals: Sequence[Rival], chance: float
) -> Rival:
    """Give the simplest explanation that no larger one beats by its price.

    Parameters
    ----------
    problem
        The recording and the model.
    null
        The model with the best constants alone.
    rivals
        Explanations that were fitted in full, of any size.
    chance
        Gain that noise alone seldom reaches. [nat]
    """
    best = null
    for size in range(1, MOST + 1):
        # What gains too little itself holds nothing back that does not.
        gaining = [
            rival
            for rival in rivals
            if len(rival.candidates) == size
            and rival.evidence - _beaten(problem, null, best, rival).evidence
            > _threshold(problem, null, best, rival, chance)
        ]
        if not gaining:
            continue
        champion = preferred(problem, gaining)
        beaten = _beaten(problem, null, best, champion)
        threshold = _threshold(problem, null, best, champion, chance)
        if worth(problem, null, beaten, champion, threshold):
            best = champion
    return best


def _beaten(problem: Problem, null: Rival, best: Rival, rival: Rival) -> Rival:
    """What a larger explanation has to beat: the best so far.

    But for a constant that is believed for less than any effect would be.
    """
    is_weak = (
        all(one.effect is None for one in best.candidates)
        and best.evidence - null.evidence <= LEAST
        and not problem.is_inflated
    )
    return best if not is_weak or {*best.names} <= {*rival.names} else null


def _threshold(
    problem: Problem, null: Rival, best: Rival, rival: Rival, chance: float
) -> float:
    """Gain that what a rival adds must have to be believed. [nat]."""
    beaten = _beaten(problem, null, best, rival)
    new = [one for one in rival.candidates if one.name not in beaten.names]
    return max(chance, least(problem, new))


def least(problem: Problem, candidates: Sequence[Candidate]) -> float:
    """Gain below which candidates are not believed, be it more than chance. [nat].

    Parameters
    ----------
    problem
        The recording and the model.
    candidates
        What an explanation has that the one before had not.
    """
    # Noise as loud as the misfit holds the doubt about the model already.
    if problem.is_inflated:
        return 0.0
    if [one.effect for one in candidates] == [None]:
        return LEAST_WRONG
    if all(is_plain(one) for one in candidates):
        return LEAST_PLAIN
    return LEAST_SLOW if any(map(_is_slow, candidates)) else LEAST


def _is_slow(candidate: Candidate) -> bool:
    effect = candidate.effect
    if effect is None:
        return False
    return effect.timed or "temperature" in effect.needs
