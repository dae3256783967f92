"""What was found, told so that a person can act on it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import exp, inf

import numpy as np

from gripperd.diagnose.fit.candidates import WRONG, Candidate
from gripperd.diagnose.fit.rival import Rival
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.bic import delta_bic
from gripperd.diagnose.search.found import Found
from gripperd.diagnose.search.rivalry import Contest
from gripperd.diagnose.verdict.gap import Gap
from gripperd.model.effect import Effect, Signal
from gripperd.model.parameter import in_use, words


@dataclass(frozen=True, slots=True)
class Estimate:
    """One fitted number. SI."""

    value: float
    std: float
    """Standard deviation."""
    low: float = -inf
    """Beyond it nothing was sought."""
    high: float = inf
    """The same above."""


@dataclass(frozen=True)
class Named:
    """One effect, or one constant, that is missing or wrong."""

    name: str
    stage: str
    effect: Effect | None
    """As it acts; none for a constant."""
    path: str | None
    """Of the constant, such as ``muscle.diameter``; none for an effect."""
    parameters: Mapping[str, Estimate]
    """By field of the effect, or by the name of the constant. [SI]"""
    size: float
    """Root mean square of its part in its signal. [SI]"""
    signal: Signal
    """Where it changes most against full scale."""
    equivalents: tuple[str, ...]
    """Names that fit as well in its place."""
    p_value: float
    """Chance of such a gain on noise alone. [-]"""
    delta_bic: float
    """BIC with it less that without it; negative if it is worth its numbers. [-]"""
    heldout_gain: float
    """Share of the mean square above the noise that the others leave on held-out runs,
    and it closes; above 1 where it ends below the noise. [-]"""

    @property
    def chosen(self) -> dict[str, str]:
        """Words that say which of several it is, such as the channel that is late."""
        return words(self.effect) if self.effect else {}


def named(
    found: Found, best: Contest, judged: Sequence[Mapping[Signal, Gap]]
) -> tuple[Named, ...]:
    """Describe everything the best explanation adds.

    Parameters
    ----------
    found, best
        The search and its outcome.
    judged
        Gaps on what was left out: for each candidate, between the best without it and
        the best.
    """
    rival = best.best
    return tuple(
        _described(found, best, index, candidate, judged[index])
        for index, candidate in enumerate(rival.candidates)
    )


def _described(
    found: Found,
    best: Contest,
    index: int,
    candidate: Candidate,
    judged: Mapping[Signal, Gap],
) -> Named:
    rival, problem = best.best, found.problem
    point = rival.fit.point
    effect = next((e for e in point.effects if e.name == candidate.name), None)
    without = best.places[index].without
    signal, size = _size(problem, rival, candidate)
    gap = judged.get(signal)
    return Named(
        name=candidate.name,
        stage=candidate.stage,
        effect=effect,
        path=candidate.name.removeprefix(WRONG) if effect is None else None,
        parameters=_estimates(problem, rival, candidate, effect),
        size=size,
        signal=signal,
        equivalents=best.equivalents[index],
        p_value=_chance(found, rival.evidence - without.evidence),
        delta_bic=delta_bic(problem, rival, without),
        heldout_gain=gap.closed if gap else 0.0,
    )


def _estimates(
    problem: Problem, rival: Rival, candidate: Candidate, effect: Effect | None
) -> dict[str, Estimate]:
    """Fitted numbers with standard deviations, as the whole fit leaves them."""
    fit, point = rival.fit, rival.fit.point
    variances = np.diag(fit.posterior)
    if effect is None:
        assert candidate.constant is not None
        constant = problem.constants[candidate.constant]
        width = float(point.widths[candidate.constant])
        shift = float(point.shifts[candidate.constant])
        value = constant.value(shift)
        std = constant.sigma * width * float(variances[candidate.constant]) ** 0.5
        reach = width * float(problem.reach(point)[candidate.constant])
        ends = constant.value(-reach), constant.value(reach)
        return {constant.path.rpartition(".")[2]: Estimate(value, std, *ends)}
    start = point.shifts.size
    sought = {
        coordinate.parameter: (
            coordinate.unit * float(variances[start + place]) ** 0.5,
            coordinate.low,
            coordinate.high,
        )
        for place, coordinate in enumerate(fit.coordinates)
        if coordinate.effect == effect.name
    }
    return {
        name: Estimate(float(getattr(effect, name)), *sought.get(name, (0.0,)))
        for name, known in in_use(effect, effect.idle).items()
        if not known.choices
    }


def _size(problem: Problem, rival: Rival, candidate: Candidate) -> tuple[Signal, float]:
    """Where the effect changes most against full scale, and by how much. [SI]."""
    there = problem.expected(problem.explanation(rival.fit.point))
    here = problem.expected(problem.explanation(_bare(rival, candidate)))
    changes: dict[Signal, list[float]] = {}
    for block, a, b in zip(problem.blocks, there, here, strict=True):
        changes.setdefault(block.signal, []).extend((a - b).tolist())
    sizes = {s: float(np.sqrt(np.mean(np.square(c)))) for s, c in changes.items()}
    signal = max(sizes, key=lambda one: sizes[one] / problem.full_scale[one])
    return signal, sizes[signal]


def _bare(rival: Rival, candidate: Candidate) -> Point:
    """The same point without the candidate, everything else left as it is."""
    point = rival.fit.point
    if candidate.constant is None:
        return point.without(candidate.name)
    shifts = point.shifts.copy()
    shifts[candidate.constant] = 0.0
    return replace(point, shifts=shifts)


def _chance(found: Found, gain: float) -> float:
    """Chance of such a gain on noise alone; beyond the draws its tail falls as e^-x."""
    nulls = found.nulls
    above = int(np.sum(nulls >= gain))
    rarest = 1 / (nulls.size + 1)
    if above:
        return above * rarest
    return rarest * exp(-min(gain - float(nulls[-1]), 600.0))
