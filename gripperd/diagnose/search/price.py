"""The price of an addition: what a larger explanation must close to be believed."""

from collections.abc import Collection, Sequence
from dataclasses import replace

import numpy as np

from gripperd.diagnose.fit.bending import bendable, bent
from gripperd.diagnose.fit.candidates import Candidate, is_exact
from gripperd.diagnose.fit.cross_validation import bears_out
from gripperd.diagnose.fit.rival import Rival
from gripperd.diagnose.residuals.explanation import moves
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.bic import STRONG, delta_bic
from gripperd.model.effect import Signal
from gripperd.model.track import Array

PHANTOM = 0.06
"""An addition that closes less of the first gap than this repairs its shape, and is
not an effect of its own: no library has the formula of nature. [-]"""
OWN = 1 / 3
"""Share of a gain that no bending of the first effects takes, from which it is that of
an effect of its own, be it ever so small. [-]"""
OWN_DOUBLE = 0.5
"""The same of what is known to look like one of them. [-]"""
MENDED = 0.05
"""Share below which it mends a form, be it ever so large. [-]"""
LEAST_OWN = 100.0
"""Fall of chi² that each effect that bends leaves at least of one of its own. [-]"""
UNBENT = 0.8
"""Share of a gain that bending leaves, from which form has no part in it. [-]"""
NEARLY = 1.1
"""Mean square of what is left, over that of noise, up to which that may still be noise:
its level is known to a twentieth. [-]"""
ELSEWHERE = 0.3
"""Share of a gain from which a signal counts as gaining. [-]"""
MUCH = 0.4
"""Share of what is left, far above the noise, that an effect of its own takes. [-]"""
EXACT = 0.25
"""Share of :data:`PHANTOM` paid by what has but one form, as the effects before that
leave nothing to repair or as the one that could repair them. [-]"""
LEAST_MORE = 25.0
"""Gain below which a further effect is not believed: the first one was fitted with a
form of ours. [nat]"""
SEEN = 0.005
"""Change of a reading, of full scale, that an effect makes at least in a sweep: common
sensors drift by 0.2 %. [-]"""
RAMP = 0.01
"""The same of a drift in proportion to time: what wanders by 0.2 % (sd) may end root 12
times that from where it began, and constants take a part of it. [-]"""


def worth(
    problem: Problem, null: Rival, best: Rival, larger: Rival, threshold: float
) -> bool:
    """Whether a larger explanation beats one by its price, and by a visible share.

    What the new part closes is held against what was closed in the signals it acts on:
    elsewhere there is no shape that it could repair.

    Parameters
    ----------
    problem
        The recording and the model.
    null
        The model with the best constants alone.
    best, larger
        The explanation to beat, and one with more in it.
    threshold
        Gain that noise alone seldom reaches. [nat]
    """
    gain = larger.evidence - best.evidence
    if gain <= threshold or not is_fault(problem, larger):
        return False
    if not best.candidates:
        acts = any(one.effect for one in larger.candidates)
        if acts and delta_bic(problem, larger, best) > STRONG:
            return False
        return size_of(problem, larger, larger.names, problem.signals) >= SEEN
    new = [one for one in larger.candidates if one.name not in best.names]
    signals = {signal for one in new for signal in acts_on(problem, one)}
    inflated = problem.inflation(signals) > 1
    if not inflated and gain <= LEAST_MORE:
        return False
    if not _is_visible(problem, best, larger, new):
        return False
    further = best.fit.cost - larger.fit.cost
    # Constants tie the stages together: it may close elsewhere what it sets free here.
    signals |= _gained(problem, best, larger)
    closed = sum(null.fit.misfits[s] - larger.fit.misfits[s] for s in signals)
    price = PHANTOM
    old = [one for one in best.candidates if acts_on(problem, one) & signals]
    for group in (old, new):
        price *= EXACT if all(is_exact(one) for one in group) else 1.0
    paid = further > price * closed
    if not inflated:
        return _stands_alone(problem, best, larger, paid=paid)
    # Far above the noise it counts what an addition takes of what was left.
    left = sum(best.fit.misfits[s] for s in signals)
    takes_much = _taken(problem, best, larger) > MUCH * left
    return (paid or takes_much) and bears_out(problem, best.fit, larger.fit, signals)


def _is_visible(
    problem: Problem, best: Rival, larger: Rival, new: Sequence[Candidate]
) -> bool:
    """Whether readings see what is new: beside the best, or each where it is gone.

    Where nothing else acts it is the first, and as visible as it is by itself.
    """
    gained = _gained(problem, best, larger)
    is_first = not any(acts_on(problem, one) & gained for one in best.candidates)
    if {*best.names} <= {*larger.names} and not is_first:
        return _change(problem, best.fit.point, larger.fit.point) >= SEEN
    sizes = (size_of(problem, larger, [o.name], problem.signals) for o in new)
    return all(size >= SEEN for size in sizes)


def is_seen(problem: Problem, best: Rival, larger: Rival) -> bool:
    """Tell whether an addition is more than noise and than what common sensors drift.

    Parameters
    ----------
    problem
        The recording and the model.
    best, larger
        An explanation, and one with more in it.
    """
    return (
        larger.evidence - best.evidence > LEAST_MORE
        and is_fault(problem, larger)
        and _change(problem, best.fit.point, larger.fit.point) >= SEEN
    )


def _taken(problem: Problem, best: Rival, larger: Rival) -> float:
    """Fall of chi² by an addition; its doubles, if it has any there, bend before."""
    further = best.fit.cost - larger.fit.cost
    bending = _bending(problem, best, larger)
    if not _looks_like(best, larger, bending):
        return further
    before, after = (bent(problem, one, bending) for one in (best, larger))
    return min(further, before - after)


def _bending(problem: Problem, best: Rival, larger: Rival) -> list[str]:
    """Effects of an explanation that act where a larger one gains, and could bend."""
    gained = _gained(problem, best, larger)
    there = {one.name for one in best.candidates if acts_on(problem, one) & gained}
    return [name for name in bendable(best) if name in there & {*larger.names}]


def _stands_alone(problem: Problem, best: Rival, larger: Rival, *, paid: bool) -> bool:
    """Whether an addition mends no form before it: what it closes stays closed.

    Those forms bend that act where it gains. One that has not paid its price must leave
    but noise, or nearly so if form has no part in its gain; if it does so only with
    forms that bend, it must keep most of its gain. Known to look like one that bends,
    it must keep most of it as well.
    """
    further = best.fit.cost - larger.fit.cost
    bending = _bending(problem, best, larger)
    before, after = (bent(problem, one, bending) for one in (best, larger))
    unbent = before - after > UNBENT * further
    least = 2 * LEAST_MORE if unbent else LEAST_OWN * len(bending) or 2 * LEAST_MORE
    noise = larger.fit.samples + (2 * larger.fit.samples) ** 0.5
    sure = paid or larger.fit.cost < noise <= before
    kept = MENDED if sure else OWN
    is_double = _looks_like(best, larger, bending)
    kept = OWN_DOUBLE if is_double else kept
    if before - after <= max(least, kept * further):
        return False
    is_other = unbent and not is_double
    return paid or after < (NEARLY * larger.fit.samples if is_other else noise)


def _gained(problem: Problem, best: Rival, larger: Rival) -> frozenset[Signal]:
    """Signals in which much of what a larger explanation gains is gained."""
    least = ELSEWHERE * (best.fit.cost - larger.fit.cost)
    gains = {s: best.fit.misfits[s] - larger.fit.misfits[s] for s in problem.signals}
    return frozenset(signal for signal, gain in gains.items() if gain > least)


def _looks_like(best: Rival, larger: Rival, bending: Collection[str]) -> bool:
    """Whether anything new is a known double of what bends."""
    old = [one for one in best.candidates if one.name in bending]
    new = [one for one in larger.candidates if one.name not in best.names]
    return any(a.name in b.doubles or b.name in a.doubles for a in old for b in new)


def _change(problem: Problem, one: Point, other: Point) -> float:
    """How far apart two explanations are where they differ most, of full scale."""
    expected = [problem.expected(problem.explanation(each)) for each in (one, other)]
    return max(
        float(np.percentile(np.abs(a - b), 95)) / problem.full_scale[block.signal]
        for block, a, b in zip(problem.blocks, *expected, strict=True)
    )


def is_fault(problem: Problem, rival: Rival) -> bool:
    """Tell whether a drift, if there is one, is more than that of a sound sensor."""
    if "force_sensor_drift" not in rival.names:
        return True
    own = Signal.FORCE in problem.signals
    signals = [Signal.FORCE] if own else problem.signals
    return size_of(problem, rival, ["force_sensor_drift"], signals) >= RAMP


def size_of(
    problem: Problem, rival: Rival, names: Sequence[str], signals: Collection[Signal]
) -> float:
    """How much some effects change most in some signals, of full scale.

    Everything else is left as it is. What takes from a reading one way and adds to it
    the other, as play does, changes it by both. Of constants it is infinite.
    """
    point = rival.fit.point
    others = tuple(one for one in point.effects if one.name not in names)
    if others == point.effects:
        return np.inf
    bare = replace(point, effects=others)
    there, here = (problem.expected(problem.explanation(p)) for p in (point, bare))
    sizes = [
        _span(a - b) / problem.full_scale[block.signal]
        for block, a, b in zip(problem.blocks, there, here, strict=True)
        if block.signal in signals
    ]
    return max(sizes)


def _span(change: Array) -> float:
    """From what it takes most to what it adds most."""
    return float(np.max(change, initial=0.0) - np.min(change, initial=0.0))


def acts_on(problem: Problem, candidate: Candidate) -> frozenset[Signal]:
    """Signals that a candidate changes, of those explained."""
    if candidate.constant is not None:
        moved = problem.constants[candidate.constant].moves
    else:
        assert candidate.effect is not None
        moved = moves(candidate.effect) or frozenset(problem.signals)
    return problem.shown(moved)
