"""Who else could it be: each effect of the best explanation against its rivals."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import islice

import numpy as np

from gripperd.diagnose.fit.candidates import Candidate, is_exact, is_plain
from gripperd.diagnose.fit.cross_validation import bears_out
from gripperd.diagnose.fit.design import Member, design
from gripperd.diagnose.fit.rival import Rival, Start, added, fitted
from gripperd.diagnose.residuals.holdout import FEW
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.belief import LEAST
from gripperd.diagnose.search.found import Found
from gripperd.diagnose.search.limit import has_become
from gripperd.diagnose.search.loop import discernible, is_but_curve, show_their_loops
from gripperd.diagnose.search.needed import needed, without_each
from gripperd.diagnose.search.preference import preferred, strained
from gripperd.diagnose.search.price import acts_on, worth

EXCHANGES = 2
"""Rounds in which a rival may take a place."""
CHALLENGERS = 4
"""Rivals of each effect that are fitted in full."""
SURE = 2.0
"""A rival behind by less could be true: a true difference of so much has a standard
error of root 2 of it, which is as much again. [nat]"""
OF_FEW = 3.0
"""By how much more it may be behind in fewer sweeps than can be left out whole: then
nothing but their ends tells which of two formulas is that of nature. [nat]"""
EVEN = 0.1
"""A rival ahead by less has only been fitted a little further, and takes no place: two
processors round differently. [nat]"""
ALIKE = 0.05
"""Share of what a name explains in its signals that a rival may leave there. [-]"""
MISSHAPED = 0.06
"""Share of the first gap within which a difference of misfit says only that neither
formula is that of nature. [-]"""


@dataclass(frozen=True)
class Place:
    """Where a candidate of the best explanation stands."""

    without: Rival
    """The best with nobody in it."""
    rivals: tuple[Rival, ...] = ()
    """Those that fit as well with another in it."""


@dataclass(frozen=True)
class Contest:
    """The best explanation after every exchange, and who could stand in for whom."""

    best: Rival
    places: tuple[Place, ...] = ()
    """One for each candidate of the best, in the same order."""
    margin: float = 0.0
    """Evidence by which a rival may be behind and fit as well; 0 where not asked. [nat]

    That is some 2, and more where more than noise is left.
    """

    @property
    def equivalents(self) -> tuple[tuple[str, ...], ...]:
        """For each candidate of the best, the names that fit as well."""
        return tuple(
            tuple(rival.candidates[index].name for rival in place.rivals)
            for index, place in enumerate(self.places)
        )


def contest(found: Found, listed: Sequence[Candidate]) -> Contest:
    """Let rivals challenge each effect in turn; a better one takes its place.

    Parameters
    ----------
    found
        The search.
    listed
        What could be missing.
    """
    problem, best = found.problem, found.best
    without = without_each(problem, best)
    challenged = _challenged(problem, best, without, listed)
    for _ in range(EXCHANGES):
        ahead = [
            rival
            for bare, rivals in zip(without, challenged, strict=True)
            for rival in rivals
            if rival.evidence > best.evidence + EVEN
            and not has_become(rival, best)
            and _pays(found, bare, rival)
        ]
        if not ahead:
            break
        champion = preferred(problem, ahead)
        if problem.is_inflated and not _sounder(problem, best, champion):
            break
        best, without = champion, without_each(problem, champion)
        challenged = _challenged(problem, best, without, listed)
    sound = _within_limits(problem, best, challenged)
    if sound is not best:
        best, without = sound, without_each(problem, sound)
        challenged = _challenged(problem, best, without, listed)
    named = _by_its_name(found, best, without, challenged)
    if named is not best:
        best, without = named, without_each(problem, named)
        challenged = _challenged(problem, best, without, listed)
    told, without = needed(problem, best, without, found.threshold)
    if told is not best:
        challenged = _challenged(problem, told, without, listed)
    pairs = zip(without, challenged, strict=True)
    places = tuple(Place(bare, tuple(rivals)) for bare, rivals in pairs)
    return standing_in(found, Contest(told, places))


def _pays(found: Found, bare: Rival, rival: Rival) -> bool:
    """Whether what takes a place would be believed there, had nobody been in it."""
    return worth(found.problem, found.null, bare, rival, found.threshold)


def standing_in(found: Found, told: Contest) -> Contest:
    """Keep of the rivals those that fit as well, best first.

    Parameters
    ----------
    found
        The search.
    told
        Its outcome, with whoever was fitted in each place.
    """
    problem, best = found.problem, told.best
    null = found.null.fit
    margin = _margin(null.cost - best.fit.cost, best.excess, best.fit.samples)
    margin += OF_FEW if len(problem.courses) < FEW else 0.0
    places = []
    for index, place in enumerate(told.places):
        rivals = sorted(place.rivals, key=lambda one: -one.evidence)
        alike = (
            rival
            for rival in rivals
            if _behind(best, rival, index) < margin
            and not has_become(rival, best)
            and not is_but_curve(rival, best)
            and not rival.is_misnamed
            and not _is_held(problem, rival, index)
            and _stands_in(found, best, index, place.without, rival)
        )
        places.append(replace(place, rivals=tuple(alike)))
    return Contest(best, tuple(places), margin)


def _behind(best: Rival, rival: Rival, index: int) -> float:
    """By how much less likely a rival is; where neither has a form, by the data. [nat].

    What was thought likely before tells a diameter from a gain no better than a coin.
    """
    behind = best.evidence - rival.evidence
    if all(_is_formless(one.candidates[index]) for one in (best, rival)):
        return min(behind, 0.5 * (rival.fit.cost - best.fit.cost))
    return behind


def _is_formless(candidate: Candidate) -> bool:
    return candidate.effect is None or is_exact(candidate)


def _within_limits(
    problem: Problem, best: Rival, challenged: Sequence[Sequence[Rival]]
) -> Rival:
    """Give the likeliest that no limit holds back, where one holds an offset or factor.

    No sensor is off by that much, so that something else is wrong that looks like it.
    """
    sound = [
        rival
        for index, rivals in enumerate(challenged)
        if _is_held(problem, best, index)
        for rival in rivals
        if not strained(problem, rival) and best.evidence - rival.evidence < LEAST
    ]
    return max(sound, key=lambda rival: rival.evidence, default=best)


def _is_held(problem: Problem, rival: Rival, index: int) -> bool:
    """Whether a candidate is an offset or a factor that stops at its limit."""
    one = rival.candidates[index]
    return is_plain(one) and strained(problem, rival, [one.name])


def _by_its_name(
    found: Found,
    best: Rival,
    without: Sequence[Rival],
    challenged: Sequence[Sequence[Rival]],
) -> Rival:
    """Give the best by the name of what it has become, if that explains as much.

    A loop that is hardly needed has become the likeliest curve.
    """
    for index, (bare, rivals) in enumerate(zip(without, challenged, strict=True)):
        for rival in rivals:
            if has_become(best, rival) and _stands_in(found, best, index, bare, rival):
                return rival
    curves = [one for own in challenged for one in own if is_but_curve(best, one)]
    return max(curves, key=lambda rival: rival.evidence, default=best)


def _challenged(
    problem: Problem,
    best: Rival,
    without: Sequence[Rival],
    listed: Sequence[Candidate],
) -> list[list[Rival]]:
    """Give the best with each of its strongest rivals, by the place they take."""
    others = discernible(problem, [o for o in listed if o.name not in best.names])
    starts = [
        _challengers(problem, bare, index, others) for index, bare in enumerate(without)
    ]
    # All at once, for places may have few.
    rivals = fitted(problem, [start for own in starts for start in own])
    told = zip(rivals, show_their_loops(problem, rivals), strict=True)
    return [[one for one, loops in islice(told, len(own)) if loops] for own in starts]


def _margin(closed: float, excess: float, samples: int) -> float:
    """By how much less a rival may have: more, if more than noise is left."""
    misfit = excess - np.sqrt(2 * samples)
    return SURE + 0.5 * float(max(min(MISSHAPED * closed, misfit), 0.0))


def _sounder(problem: Problem, best: Rival, champion: Rival) -> bool:
    """Whether an exchange is held by no limit, and foretells better what it acts on."""
    if strained(problem, champion) or preferred(problem, [best, champion]) is best:
        return False
    changed = set(best.candidates) ^ set(champion.candidates)
    signals = {signal for one in changed for signal in acts_on(problem, one)}
    return bears_out(problem, best.fit, champion.fit, signals)


def _stands_in(
    found: Found, best: Rival, index: int, without: Rival, rival: Rival
) -> bool:
    """Whether a rival explains the same signals, not others as much better.

    How badly others fit excuses nothing in these.
    """
    signals = acts_on(found.problem, best.candidates[index])
    own, other, bare, null = (
        sum(one.fit.misfits[signal] for signal in signals)
        for one in (best, rival, without, found.null)
    )
    samples = sum(best.fit.counts[signal] for signal in signals)
    margin = SURE + _margin(null - own, own - samples, samples)
    return 0.5 * (other - own) < margin + 0.5 * ALIKE * (bare - own)


def _challengers(
    problem: Problem, without: Rival, index: int, others: Sequence[Candidate]
) -> list[Start]:
    """Put each of the strongest others into the place that one has left."""
    rest, base = without.candidates, without.fit.point
    around = design(problem, base, others)
    leaders: dict[str, tuple[float, Member]] = {}
    for member in around.members:
        evidence = around.fit(member).evidence
        name = member.candidate.name
        if name not in leaders or evidence > leaders[name][0]:
            leaders[name] = evidence, member
    strongest = sorted(leaders.values(), key=lambda one: -one[0])[:CHALLENGERS]
    chosen = [member.candidate for _, member in strongest]
    return [((*rest[:index], one, *rest[index:]), added(base, one)) for one in chosen]
