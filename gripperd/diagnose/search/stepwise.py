"""Which effects: singles, pairs, then forward and backward, each paid for.

References
----------
.. [1] A. J. Miller, "Subset Selection in Regression", 2nd ed., Chapman & Hall, 2002,
       sections 3.2-3.6: forward, backward and exchange steps.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import reduce
from types import MappingProxyType
from typing import TypeAlias

import numpy as np

from gripperd.diagnose.fit.candidates import Candidate, is_plain
from gripperd.diagnose.fit.design import Member, design
from gripperd.diagnose.fit.inflation import birge_ratios, louder, plain, reached
from gripperd.diagnose.fit.null import null_gains
from gripperd.diagnose.fit.polish import polished
from gripperd.diagnose.fit.rival import Rival, added, fitted, larger
from gripperd.diagnose.readings.course import is_table
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.finalists import finalists, heard, leaders
from gripperd.diagnose.search.found import Found
from gripperd.diagnose.search.loop import discernible, shows_its_loop
from gripperd.diagnose.search.preference import BORE, at_edge, preferred
from gripperd.diagnose.search.price import worth

FALSE_ALARMS = 0.01
"""Share of recordings without a discrepancy in which something may be found."""
LEAST = 13.0
"""Gain below which no model of a rig is known well enough: odds of 4e5. In 96
recordings of six rigs that lacked nothing the most was 10, but for delays that are too
short to be seen. [nat]"""
LEAST_SLOW = 20.0
"""The same of what time, order or warmth tells, as it does a drift: odds of 5e8. One in
eight drifts of 0.2 % of full scale gave 17. [nat]"""
LEAST_BESIDE = 20.0
"""The same beside another effect, whose formula is ours. [nat]"""
LEAST_PLAIN = 8.0
"""The same of an offset or a factor, which little resembles: odds of 3000. [nat]"""
LEAST_WRONG = 2.5
"""The same of one constant: against it stands that all parts are as stated, and no form
that is ours: odds of 12. In 168 recordings of seven rigs, all of sound constants, the
most was 2.4. [nat]"""
MISFIT = 2.0
"""Mean square of what the best explanation leaves, from which it is not noise. [-]"""
HOPELESS = 150.0
"""The same of the null, from which no explanation can reach the noise. [-]"""
DEFLATIONS = 3
"""Passes after the first, each with noise no louder than the one before left it."""
NEXT = 2
"""Explanations that are fitted in full."""
MOST = 4
"""Effects that one recording may add."""

Starts: TypeAlias = Mapping[tuple[Candidate, ...], Point]
"""Where a fit of some candidates ended when the noise was taken to be louder."""


def search(
    problem: Problem, listed: Sequence[Candidate], rng: np.random.Generator
) -> Found:
    """Find the explanation that the recording supports best.

    Parameters
    ----------
    problem
        The recording and the model.
    listed
        What could be missing.
    rng
        For the recordings without a discrepancy.
    """
    found = _settled(problem, listed, rng)
    discerned = discernible(found.problem, listed)
    if len(discerned) < len(listed):
        found = _settled(problem, discerned, rng)
    return _grown(found, discerned)


def _settled(
    problem: Problem, listed: Sequence[Candidate], rng: np.random.Generator
) -> Found:
    """Search until the noise is as loud as what is left; where that is far, plainly."""
    start = Point(np.zeros(len(problem.constants)))
    null = polished(problem, start)
    lost = [s for s, share in birge_ratios(null).items() if share > HOPELESS]
    found = _deflated(plain(problem, lost), listed, rng, null.point)
    inflated = [s for s, share in found.problem.inflations.items() if share > MISFIT]
    if set(inflated) - set(lost):
        found = _deflated(plain(problem, [*lost, *inflated]), listed, rng, null.point)
    return found


def _deflated(
    problem: Problem,
    listed: Sequence[Candidate],
    rng: np.random.Generator,
    start: Point,
) -> Found:
    """Take the noise as loud as the best explanation leaves it, and no louder."""
    null = polished(problem, start)
    inflated = {s: max(1.0, share) for s, share in birge_ratios(null).items()}
    found = _pass(louder(problem, inflated), listed, rng, null.point)
    for _ in range(DEFLATIONS):
        lower = reached(inflated, (rival.fit for rival in found.rivals))
        if all(lower[s] > 0.8 * inflated[s] for s in inflated):
            break
        inflated = lower
        known = {rival.candidates: rival.fit.point for rival in found.rivals}
        found = _pass(louder(problem, inflated), listed, rng, null.point, known)
    return found


def _pass(
    problem: Problem,
    listed: Sequence[Candidate],
    rng: np.random.Generator,
    start: Point,
    known: Starts = MappingProxyType({}),
) -> Found:
    null = Rival((), polished(problem, start))
    around = design(problem, null.fit.point, listed)
    base = around.fit().evidence
    singles = {member: around.fit(member).evidence - base for member in around.members}
    gains = _by_name(singles)
    nulls = null_gains(around, around.members, rng)
    chance = float(np.quantile(nulls, 1 - FALSE_ALARMS))
    rivals = [null]
    # What is inflated is weighed even so: only a fit tells how loud the rest really is.
    if problem.is_inflated or any(
        gain > max(chance, _least(problem, [member.candidate]))
        for member, gain in singles.items()
    ):
        # A table has so few samples that every form can be fitted in full.
        thrifty = not is_table(problem.courses)
        sets = finalists(problem, around, singles, thrifty=thrifty)
        rivals += _fitted(problem, null.fit.point, sets, known)
        rivals = [one for one in rivals if shows_its_loop(problem, one)]
        alone = [one for one in rivals if len(one.candidates) == 1] or [null]
        rivals += _with_bore(problem, preferred(problem, alone), listed)
    best = _best(problem, null, rivals, chance)
    threshold = max(chance, 0.0 if problem.is_inflated else LEAST_BESIDE)
    rivals.sort(key=lambda rival: -rival.evidence)
    return Found(
        problem, null, best, tuple(rivals), threshold, gains, around.faint, nulls
    )


def _by_name(singles: dict[Member, float]) -> dict[str, float]:
    gains: dict[str, float] = {}
    for member, gain in singles.items():
        name = member.candidate.name
        gains[name] = max(gains.get(name, 0.0), gain)
    return gains


def _fitted(
    problem: Problem,
    start: Point,
    sets: Sequence[Sequence[Member]],
    known: Starts,
) -> list[Rival]:
    chosen = [tuple(member.candidate for member in members) for members in sets]
    return fitted(
        problem, [(one, known.get(one, reduce(added, one, start))) for one in chosen]
    )


def _with_bore(
    problem: Problem, rival: Rival, listed: Sequence[Candidate]
) -> list[Rival]:
    """Give it with another bore, if misfit counts and its tolerance holds that back."""
    held = BORE in at_edge(problem, rival) and BORE not in rival.names
    if not (problem.is_inflated and held):
        return []
    return larger(problem, rival, [one for one in listed if one.name == BORE])


def _best(
    problem: Problem, null: Rival, rivals: Sequence[Rival], chance: float
) -> Rival:
    """The simplest explanation that no larger one beats by its price."""
    best = null
    for size in range(1, MOST + 1):
        of_size = [rival for rival in rivals if len(rival.candidates) == size]
        # What is not believed itself holds nothing back that is.
        believed = [
            rival
            for rival in of_size
            if rival.evidence - best.evidence > _threshold(problem, best, rival, chance)
        ]
        if not believed:
            continue
        champion = preferred(problem, believed)
        threshold = _threshold(problem, best, champion, chance)
        if worth(problem, null, best, champion, threshold):
            best = champion
    return best


def _threshold(problem: Problem, best: Rival, rival: Rival, chance: float) -> float:
    """Gain over the best that what a rival adds must have to be believed. [nat]."""
    new = [one for one in rival.candidates if one.name not in best.names]
    return max(chance, _least(problem, new))


def _least(problem: Problem, candidates: Sequence[Candidate]) -> float:
    """Gain below which they are not believed, be it more than chance. [nat]."""
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
    return effect is not None and (effect.timed or "temperature" in effect.needs)


def _grown(found: Found, listed: Sequence[Candidate]) -> Found:
    """Add one effect at a time for as long as it is worth its price."""
    problem, best = found.problem, found.best
    tried: list[Rival] = []
    while 0 < len(best.candidates) < MOST:
        grown = additions(found, best, listed, NEXT)
        tried += grown
        if not grown:
            break
        champion = preferred(problem, grown)
        if not worth(problem, found.null, best, champion, found.threshold):
            break
        best = champion
    rivals = sorted((*found.rivals, *tried), key=lambda rival: -rival.evidence)
    return replace(found, best=best, rivals=tuple(rivals))


def additions(
    found: Found, rival: Rival, listed: Sequence[Candidate], most: int
) -> list[Rival]:
    """Give an explanation with one more, for each of the few that promise most.

    Parameters
    ----------
    found
        The search.
    rival
        The explanation.
    listed
        What could be missing.
    most
        How many are a few.
    """
    problem = found.problem
    around = design(problem, rival.fit.point, discernible(problem, listed))
    base = around.fit().evidence
    singles = {m: around.fit(m).evidence - base for m in around.members}
    alone = [(member,) for member in leaders(singles)]
    more = [
        member.candidate
        for (member,) in heard(problem, singles, alone, most)
        if singles[member] > found.threshold
    ]
    grown = larger(problem, rival, more) + _with_bore(problem, rival, listed)
    return [one for one in grown if shows_its_loop(problem, one)]
