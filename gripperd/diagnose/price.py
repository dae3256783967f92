"""The price of an addition: what a larger explanation must close to be believed."""

import numpy as np

from gripperd.diagnose.candidates import Candidate, is_exact
from gripperd.diagnose.crossing import bears_out
from gripperd.diagnose.point import Point
from gripperd.diagnose.problem import Problem
from gripperd.diagnose.response import moves
from gripperd.diagnose.rival import Rival
from gripperd.model.effect import Signal

PHANTOM = 0.06
"""An addition that closes less of the first gap than this repairs its shape, and is
not an effect of its own: no library has the formula of nature. [-]"""
COMPLETE = 0.01
"""The same of an addition that leaves nothing but noise. [-]"""
ELSEWHERE = 0.3
"""Share of a gain from which a signal counts as gaining. [-]"""
HALF = 0.4
"""Share of what is left, far above the noise, that an effect of its own takes. [-]"""
EXACT = 0.25
"""Share of :data:`PHANTOM` paid by what has but one form, as the first effect that
leaves nothing to repair or as the one that could repair it. [-]"""
LEAST_MORE = 25.0
"""Gain below which a further effect is not believed: the first one was fitted with a
form of ours. [nat]"""
SEEN = 0.006
"""Change of a reading, of full scale, that a further effect makes at least in a sweep:
common sensors drift by a third of it. [-]"""


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
    if not best.candidates or gain <= threshold:
        return gain > threshold
    new = [one for one in larger.candidates if one.name not in best.names]
    signals = {signal for one in new for signal in acts_on(problem, one)}
    hot = problem.temperature(signals) > 1
    if not hot and gain <= LEAST_MORE:
        return False
    if _change(problem, best.fit.point, larger.fit.point) < SEEN:
        return False
    further = best.fit.cost - larger.fit.cost
    # Constants tie the stages together: it may close elsewhere what it sets free here.
    gained = {s: best.fit.misfits[s] - larger.fit.misfits[s] for s in problem.signals}
    signals |= {s for s, gain in gained.items() if gain > ELSEWHERE * further}
    closed = sum(null.fit.misfits[s] - larger.fit.misfits[s] for s in signals)
    noise = (2 * larger.fit.samples) ** 0.5
    complete = not hot and larger.excess < noise
    price = COMPLETE if complete else PHANTOM
    for group in (best.candidates[:1], new):
        price *= EXACT if group and all(is_exact(one) for one in group) else 1.0
    # Far above the noise it counts what an addition takes of what was left.
    halves = hot and further > HALF * sum(best.fit.misfits[s] for s in signals)
    if not halves and further <= price * closed:
        return False
    return not hot or bears_out(problem, best.fit, larger.fit, signals)


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
