"""Which effects: singles, pairs, then forward and backward, each paid for.

References
----------
.. [1] A. J. Miller, "Subset Selection in Regression", 2nd ed., Chapman & Hall, 2002,
       sections 3.2-3.6: forward, backward and exchange steps.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from gripperd.diagnose.candidates import Candidate, is_exact
from gripperd.diagnose.design import Design, Member, design
from gripperd.diagnose.noise import Noise
from gripperd.diagnose.null import null_gains
from gripperd.diagnose.polish import Polished, polished
from gripperd.diagnose.problem import Point, Problem, moves
from gripperd.model.effect import Signal

FALSE_ALARMS = 0.01
"""Share of recordings without a discrepancy in which something may be found."""
PHANTOM = 0.06
"""An addition that closes less of the first gap than this repairs its shape, and is
not an effect of its own: no library has the formula of nature. [-]"""
ELSEWHERE = 0.3
"""Share of a gain from which a signal counts as gaining. [-]"""
HALF = 0.4
"""Share of what is left, far above the noise, that an effect of its own takes. [-]"""
EXACT = 0.25
"""The same is dearer by so much less for what has but one form, as the first effect
that leaves nothing to repair or as the one that could repair it. [-]"""
HOT = 1.3
"""Mean square of whitened residuals above which the library does not reach the noise:
what is left is then taken for noise, or every constant would be torn. [-]"""
LEAST = 20.0
"""Gain below which no model of a rig is known well enough: odds of 5e8. [nat]"""
MISFIT = 2.0
"""Mean square of what the best explanation leaves, from which it is not noise. [-]"""
LEAST_MORE = 45.0
"""The same of a further effect: the first one was fitted with a form of ours. [nat]"""
SEEN = 0.0025
"""Change of a reading, of full scale, that a further effect makes at least in a sweep:
sensors drift by as much. [-]"""
HOPELESS = 150.0
"""The same of the null, from which no explanation can reach the noise. [-]"""
COOLINGS = 3
FINALISTS = 4
NEXT = 2
"""Explanations that are fitted in full."""
MOST = 4
"""Effects that one recording may add."""


@dataclass(frozen=True)
class Rival:
    """One explanation, fitted in full."""

    candidates: tuple[Candidate, ...]
    fit: Polished

    @property
    def names(self) -> tuple[str, ...]:
        """What it adds to the model."""
        return tuple(one.name for one in self.candidates)

    @property
    def evidence(self) -> float:
        """Log of its marginal likelihood (Laplace). [nat]."""
        volume = np.linalg.slogdet(self.fit.covariance)[1]
        return float(-0.5 * self.fit.cost + 0.5 * volume)

    @property
    def excess(self) -> float:
        """Chi² above what noise alone has. [-]."""
        return float(sum(self.fit.misfits.values())) - self.fit.samples


@dataclass(frozen=True)
class Found:
    """Outcome of the search."""

    problem: Problem
    null: Rival
    best: Rival
    rivals: tuple[Rival, ...]
    """All that were fitted in full, best first."""
    threshold: float
    """Gain that noise alone reaches in :data:`FALSE_ALARMS` of recordings. [nat]"""
    gains: dict[str, float]
    """Gain of each name alone, linear. [nat]"""
    faint: tuple[str, ...]
    """Names that leave no trace in this recording."""
    nulls: np.ndarray[tuple[int], np.dtype[np.float64]]


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
    start = Point(np.zeros(len(problem.constants)))
    null = polished(problem, start)
    found = None
    if _temperature(null) < HOPELESS:
        found = _cooled(problem, listed, rng, null.point)
    if found is None or found.problem.temperature > MISFIT:
        found = _cooled(_plain(problem), listed, rng, null.point)
    return _grown(found, listed)


def _cooled(
    problem: Problem,
    listed: Sequence[Candidate],
    rng: np.random.Generator,
    start: Point,
) -> Found:
    """Take the noise as loud as the best explanation leaves it, and no louder."""
    null = polished(problem, start)
    temperature = max(1.0, _temperature(null))
    found = _pass(_louder(problem, temperature), listed, rng, null.point)
    for _ in range(COOLINGS):
        coolest = min(_temperature(rival.fit) for rival in found.rivals)
        cooler = max(1.0, temperature * coolest)
        if cooler > 0.8 * temperature:
            break
        temperature = cooler
        found = _pass(_louder(problem, temperature), listed, rng, null.point)
    return found


def _plain(problem: Problem) -> Problem:
    """Give the problem with noise that has no memory.

    Where no explanation comes near the noise, its fine law says nothing about what is
    left, and every newton of misfit counts the same.
    """
    noises = {
        signal: Noise(noise.std, 0.0, 1e-3 * noise.std, noise.memory)
        for signal, noise in problem.noises.items()
    }
    return replace(problem, noises=noises)


def _temperature(fit: Polished) -> float:
    """Mean square of what is left, whitened; 1 when it is the noise alone."""
    share = sum(fit.misfits.values()) / fit.samples
    return share if share > HOT or share < 1 else 1.0


def _louder(problem: Problem, temperature: float) -> Problem:
    """Give the problem with noise as loud as what no explanation reaches."""
    louder = temperature**0.5
    noises = {
        signal: Noise(
            noise.std * louder, noise.correlation, noise.drift * louder, noise.memory
        )
        for signal, noise in problem.noises.items()
    }
    return replace(problem, noises=noises, temperature=temperature)


def _pass(
    problem: Problem,
    listed: Sequence[Candidate],
    rng: np.random.Generator,
    start: Point,
) -> Found:
    null = Rival((), polished(problem, start))
    around = design(problem, null.fit.point, listed)
    base = around.fit().evidence
    singles = {member: around.fit(member).evidence - base for member in around.members}
    gains = _by_name(singles)
    nulls = null_gains(around, around.members, rng)
    # Noise as loud as the misfit holds the doubt about the model already.
    least = LEAST if problem.temperature == 1 else 0.0
    threshold = max(float(np.quantile(nulls, 1 - FALSE_ALARMS)), least)
    rivals = [null]
    # What is hot is weighed even so: only a fit tells how loud the rest really is.
    hot = problem.temperature > 1
    if hot or max(gains.values(), default=0.0) > threshold:
        sets = _finalists(around, singles, base)
        rivals += [_fitted(problem, null.fit.point, members) for members in sets]
    best = _best(problem, null, rivals, threshold)
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


def _leaders(singles: dict[Member, float]) -> list[Member]:
    """Best form of each name, best first."""
    leaders: dict[str, Member] = {}
    for member in sorted(singles, key=lambda one: -singles[one]):
        leaders.setdefault(member.candidate.name, member)
    return list(leaders.values())


def _finalists(
    around: Design, singles: dict[Member, float], base: float
) -> list[tuple[Member, ...]]:
    """Best singles and best pairs by the linear fit."""
    leaders = _leaders(singles)
    # A threshold makes the linear rank of some unfair to them: known doubles of the
    # leader are heard as well.
    doubles = leaders[0].candidate.doubles
    late = [one for one in leaders[FINALISTS:] if one.candidate.name in doubles]
    sets: list[tuple[Member, ...]] = [(one,) for one in leaders[:FINALISTS] + late]
    pairs = [
        (around.fit(one, other).evidence, (one, other))
        for one, other in combinations(leaders, 2)
    ]
    pairs.sort(key=lambda pair: -pair[0])
    return sets + [members for _, members in pairs[:FINALISTS]]


def _fitted(problem: Problem, start: Point, members: Sequence[Member]) -> Rival:
    point = start
    for member in members:
        point = added(point, member.candidate)
    return Rival(tuple(m.candidate for m in members), polished(problem, point))


def added(point: Point, candidate: Candidate) -> Point:
    """Put a candidate in at a point."""
    if candidate.effect is not None:
        return point.with_effect(candidate.effect)
    assert candidate.constant is not None
    return replace(point, freed=point.freed | {candidate.constant})


def _best(
    problem: Problem, null: Rival, rivals: Sequence[Rival], threshold: float
) -> Rival:
    """The simplest explanation that no larger one beats by its price."""
    best = null
    for size in range(1, MOST + 1):
        of_size = [rival for rival in rivals if len(rival.candidates) == size]
        if not of_size:
            continue
        champion = max(of_size, key=lambda rival: rival.evidence)
        if _worth(problem, null, best, champion, threshold):
            best = champion
    return best


def _worth(
    problem: Problem, null: Rival, best: Rival, larger: Rival, threshold: float
) -> bool:
    """Whether a larger explanation beats one by its price, and by a visible share.

    What the new part closes is held against what was closed in the signals it acts on:
    elsewhere there is no shape that it could repair.
    """
    gain = larger.evidence - best.evidence
    if not best.candidates or gain <= threshold:
        return gain > threshold
    if problem.temperature == 1 and gain <= LEAST_MORE:
        return False
    if _change(problem, best.fit.point, larger.fit.point) < SEEN:
        return False
    new = [one for one in larger.candidates if one.name not in best.names]
    further = best.fit.cost - larger.fit.cost
    signals = {signal for one in new for signal in acts_on(problem, one)}
    # Constants tie the stages together: it may close elsewhere what it sets free here.
    gained = {s: best.fit.misfits[s] - larger.fit.misfits[s] for s in problem.signals}
    signals |= {s for s, gain in gained.items() if gain > ELSEWHERE * further}
    closed = sum(null.fit.misfits[s] - larger.fit.misfits[s] for s in signals)
    price = PHANTOM
    for group in (best.candidates[:1], new):
        price *= EXACT if group and all(is_exact(one) for one in group) else 1.0
    # Far above the noise it counts what an addition takes of what was left.
    halves = problem.temperature > 1 and further > HALF * best.fit.cost
    return halves or further > price * closed


def _change(problem: Problem, one: Point, other: Point) -> float:
    """How far apart two explanations are where they differ most, of full scale."""
    expected = [problem.expected(problem.explanation(each)) for each in (one, other)]
    return max(
        float(np.percentile(np.abs(a - b), 95)) / problem.full_scale[block.signal]
        for block, a, b in zip(problem.blocks, *expected, strict=True)
    )


def acts_on(problem: Problem, candidate: Candidate) -> frozenset[Signal]:
    """Signals that a candidate changes, of those explained."""
    if candidate.constant is not None:
        moved = problem.constants[candidate.constant].moves
    else:
        assert candidate.effect is not None
        moved = moves(candidate.effect) or frozenset(problem.signals)
    return moved & frozenset(problem.signals)


def _grown(found: Found, listed: Sequence[Candidate]) -> Found:
    """Add one effect at a time for as long as it is worth its price."""
    problem, best = found.problem, found.best
    tried: list[Rival] = []
    while 0 < len(best.candidates) < MOST:
        around = design(problem, best.fit.point, listed)
        base = around.fit().evidence
        singles = {m: around.fit(m).evidence - base for m in around.members}
        grown = [
            Rival(
                (*best.candidates, member.candidate),
                polished(problem, added(best.fit.point, member.candidate)),
            )
            for member in _leaders(singles)[:NEXT]
            if singles[member] > found.threshold
        ]
        tried += grown
        champion = max(grown, key=lambda rival: rival.evidence, default=None)
        if champion is None or not _worth(
            problem, found.null, best, champion, found.threshold
        ):
            break
        best = champion
    rivals = sorted((*found.rivals, *tried), key=lambda rival: -rival.evidence)
    return replace(found, best=best, rivals=tuple(rivals))
