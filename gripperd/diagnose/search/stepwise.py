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

from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.fit.design import Member, design
from gripperd.diagnose.fit.inflation import birge_ratios, louder, plain, reached
from gripperd.diagnose.fit.null import null_gains
from gripperd.diagnose.fit.polish import polished
from gripperd.diagnose.fit.rival import Rival, added, fitted, larger
from gripperd.diagnose.readings.course import is_table
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.belief import LEAST_BESIDE, MOST, least, simplest
from gripperd.diagnose.search.finalists import finalists, heard, leaders
from gripperd.diagnose.search.found import Found
from gripperd.diagnose.search.loop import discernible, show_their_loops
from gripperd.diagnose.search.preference import BORE, at_edge, preferred
from gripperd.diagnose.search.price import worth

FALSE_ALARMS = 0.01
"""Share of recordings without a discrepancy in which something may be found."""
MISFIT = 2.0
"""Mean square of what the best explanation leaves, from which it is not noise. [-]"""
HOPELESS = 150.0
"""The same of the null, from which no explanation can reach the noise. [-]"""
DEFLATIONS = 3
"""Passes after the first, each with noise no louder than the one before left it."""
NEXT = 2
"""Explanations that are fitted in full."""

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
        gain > max(chance, least(problem, [member.candidate]))
        for member, gain in singles.items()
    ):
        # A table has so few samples that every form can be fitted in full.
        thrifty = not is_table(problem.courses)
        sets = finalists(problem, around, singles, thrifty=thrifty)
        rivals += _fitted(problem, null.fit.point, sets, known)
        shown = show_their_loops(problem, rivals)
        rivals = [one for one, loops in zip(rivals, shown, strict=True) if loops]
        alone = [one for one in rivals if len(one.candidates) == 1] or [null]
        rivals += _with_bore(problem, preferred(problem, alone), listed)
    best = simplest(problem, null, rivals, chance)
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
    shown = show_their_loops(problem, grown)
    return [one for one, loops in zip(grown, shown, strict=True) if loops]
