"""From an explanation to a verdict."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum

from gripperd.diagnose.fit.polish import Polished
from gripperd.diagnose.residuals.holdout import FEW
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.found import Found
from gripperd.diagnose.search.rivalry import Contest
from gripperd.diagnose.verdict.burst import bursts
from gripperd.diagnose.verdict.gap import REACHED, Gap
from gripperd.diagnose.verdict.handed_on import not_handed_on
from gripperd.diagnose.verdict.structure import (
    VISIBLE,
    WANDERS,
    Structure,
    loudness,
    structures,
)
from gripperd.model.effect import Signal

STRUCTURED = 1e-4
"""Chance below which what is left is no noise, over all ways of looking at it."""
LOUD = 2.0
"""Mean square of what is left, in whatever order, from which it is no noise: that of a
sensor is known to a tenth. [-]"""
FAR = 3.0
"""Standard errors of a mean square on top: few samples know their noise less well."""
EXPLAINED = 0.85
"""Share of the structure that a right explanation takes away, in whatever form: on rigs
nobody here had seen 0.91 at least, and 0.83 at most of what no library holds. [-]"""


class Verdict(StrEnum):
    """What a diagnosis can say."""

    NAMED = "named"
    NONE = "none"
    UNEXPLAINED = "unexplained"
    AMBIGUOUS = "ambiguous"
    UNUSABLE = "unusable"

    @property
    def establishes(self) -> bool:
        """Whether anything is said to be missing or wrong by its name."""
        return self in (Verdict.NAMED, Verdict.AMBIGUOUS)


@dataclass(frozen=True)
class Conclusion:
    """The verdict and what it rests on."""

    verdict: Verdict
    left: tuple[Structure, ...]
    """What is left after the best explanation."""
    share: float
    """Share of the structure that the best explanation takes away, of all or of the
    signal of which it takes the least. [-]"""
    before: tuple[Structure, ...] = ()
    """What is left with the best constants alone."""
    louder: Mapping[Signal, float] = field(default_factory=dict)
    """Times the noise that is left of a signal, if that is too much for noise. [-]"""
    bursts: Mapping[Signal, int] = field(default_factory=dict)
    """How often a signal is far off for a while, if it is so again and again."""
    alone: Mapping[Signal, float] = field(default_factory=dict)
    """How far a grip is off where the force that it follows is not. [N]"""
    left_out: Mapping[Signal, float] = field(default_factory=dict)
    """Times what can be reached that a signal is off in what took no part, if nothing
    is missing in what did. [-]"""

    @property
    def signals(self) -> tuple[Signal, ...]:
        """Those in which more than noise is left."""
        structured = (one.signal for one in _remaining(self.left))
        return tuple(dict.fromkeys((*structured, *self.odd, *self.left_out)))

    @property
    def odd(self) -> tuple[Signal, ...]:
        """Those in which what is left is no noise, in whatever order it is."""
        return (*self.louder, *self.bursts, *self.alone)


def conclude(
    problem: Problem, found: Found, contest: Contest, *, is_near: bool = False
) -> Conclusion:
    """Weigh what was found against what is left.

    Parameters
    ----------
    problem
        With the noise as it was identified, not louder.
    found, contest
        The search and its outcome.
    is_near
        Whether that is but near, and no explanation.
    """
    before = _structured(problem, found.null.fit)
    after = _structured(problem, contest.best.fit)
    remaining = _remaining(after)
    # Of each by itself as well: what is large in one hides what is left of another.
    plain = {one.signal for one in remaining if one.size > WANDERS}
    share = min(_share(before, after, each) for each in (None, *plain))
    is_open = bool(remaining) and share < EXPLAINED
    louder = _louder(problem, contest.best.fit)
    residuals = problem.residuals(contest.best.fit.point)
    often = bursts(problem, residuals)
    alone: dict[Signal, float] = {}
    if not contest.best.candidates:
        # Where forces are explained they tell what of a grip is not.
        alone = not_handed_on(problem, residuals)
        is_odd = remaining or louder or often or alone
        verdict = Verdict.UNEXPLAINED if is_odd else Verdict.NONE
    elif is_near or contest.best.is_misnamed or is_open:
        verdict = Verdict.UNEXPLAINED
    elif any(contest.equivalents):
        verdict = Verdict.AMBIGUOUS
    else:
        verdict = Verdict.NAMED
    return Conclusion(verdict, after, share, before, louder, often, alone)


def not_confirmed(conclusion: Conclusion, *, is_open: bool) -> Conclusion:
    """Withdraw names that sweeps which took no part do not bear out.

    Parameters
    ----------
    conclusion
        With names.
    is_open
        Whether these sweeps are off by more than noise without any name. Where they
        are not, and no structure is seen either, sensors drift and nothing is missing.
    """
    if not conclusion.verdict.establishes:
        return conclusion
    remains = is_open or bool(_remaining(conclusion.before)) or bool(conclusion.odd)
    verdict = Verdict.UNEXPLAINED if remains else Verdict.NONE
    return replace(conclusion, verdict=verdict)


def not_closed(
    problem: Problem,
    conclusion: Conclusion,
    judged: Mapping[Signal, Gap],
    steady: Mapping[Signal, float],
) -> Conclusion:
    """Withdraw that nothing is missing where sweeps which took no part are off.

    What happened in them alone no other can tell. Where but the end of each is left
    out, it goes where none of them has been. A sensor that drifts is off as well.

    Parameters
    ----------
    problem
        Whose full scales say what is visible.
    conclusion
        With a verdict.
    judged
        Gaps on what was left out.
    steady
        The same with the best constants, but for the drift of sensors. [SI]
    """
    left_out = {
        signal: gap.left_open
        for signal, gap in judged.items()
        if gap.is_open
        and steady[signal] > REACHED * gap.reachable
        and gap.recalibrated > VISIBLE * problem.full_scale[signal]
    }
    are_whole = len(problem.courses) >= FEW
    if conclusion.verdict is not Verdict.NONE or not (left_out and are_whole):
        return conclusion
    return replace(
        conclusion, verdict=Verdict.UNEXPLAINED, share=0.0, left_out=left_out
    )


def _structured(problem: Problem, fit: Polished) -> tuple[Structure, ...]:
    return structures(problem, problem.residuals(fit.point))


def _louder(problem: Problem, fit: Polished) -> dict[Signal, float]:
    """Signals of which visibly more is left than their noise, and how much louder."""
    found = {}
    for signal, square in loudness(problem, problem.residuals(fit.point)).items():
        over = max(square - 1, 0.0) ** 0.5 * problem.noises[signal].std
        least = LOUD * (1 + FAR * (2 / fit.counts[signal]) ** 0.5)
        if square > least and over > VISIBLE * problem.full_scale[signal]:
            found[signal] = square**0.5
    return found


def _share(
    before: Sequence[Structure],
    after: Sequence[Structure],
    signal: Signal | None = None,
) -> float:
    """Share of the structure, of all or of one signal, that is taken away. [-]."""
    excess, left = (
        max((one.excess for one in found if signal in (None, one.signal)), default=0.0)
        for found in (before, after)
    )
    return 1 - max(left, 0.0) / excess if excess > 0 else 1.0


def _remaining(found: Sequence[Structure]) -> list[Structure]:
    return [
        one
        for one in found
        if one.p_value * len(found) < STRUCTURED
        and one.size > max(VISIBLE, one.wanders)
    ]
