"""Rivals: explanations that were fitted in full, to be weighed by their evidence."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np

from gripperd.diagnose.fit.candidates import Candidate, surprise
from gripperd.diagnose.fit.polish import LEAST_ON, Polished, polished
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.side_by_side import side_by_side
from gripperd.model.parameter import in_use


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
        within = float(-0.5 * self.fit.cost + 0.5 * volume)
        unusual = sum(map(surprise, self.fit.point.effects))
        return within - self.fit.point.surprise - unusual

    @property
    def is_misnamed(self) -> bool:
        """Whether numbers of an effect lie where nothing is that bears its name."""
        return any(one.is_misnamed for one in self.fit.point.effects)

    @property
    def excess(self) -> float:
        """Chi² above what noise alone has. [-]."""
        return float(sum(self.fit.misfits.values())) - self.fit.samples


Start: TypeAlias = tuple[tuple[Candidate, ...], Point]
"""An explanation before its fit, and a point nearby at which it acts."""


def fitted(problem: Problem, starts: Sequence[Start]) -> list[Rival]:
    """Fit some explanations, side by side."""
    points = [point for _, point in starts]
    fits = side_by_side(lambda one: _fitted(problem, one), points, problem.processes)
    return [Rival(one, fit) for (one, _), fit in zip(starts, fits, strict=True)]


def _fitted(problem: Problem, point: Point) -> Polished:
    """Fit it, and the law that it has come next to, to which no small step leads."""
    fit = polished(problem, point)
    plain = _switched_off(fit.point)
    if plain is fit.point:
        return fit
    return min(fit, polished(problem, plain), key=lambda one: one.cost)


def _switched_off(point: Point) -> Point:
    """Give a point with 0 for every shape that ended where 0 would be another law.

    Its effects act in the same order, so that nothing else differs.
    """
    for effect in point.effects:
        off = {
            name: 0.0
            for name, known in in_use(effect, effect.idle).items()
            if known.switches and 0 < getattr(effect, name) <= LEAST_ON * known.high
        }
        if off:
            point = point.changed(replace(effect, **off))
    return point


def larger(
    problem: Problem, rival: Rival, candidates: Iterable[Candidate]
) -> list[Rival]:
    """Give an explanation with one more, for each of some, everything fitted anew."""
    here = rival.fit.point
    return fitted(
        problem, [((*rival.candidates, one), added(here, one)) for one in candidates]
    )


def added(point: Point, candidate: Candidate) -> Point:
    """Put a candidate in at a point."""
    if candidate.effect is not None:
        return point.with_effect(candidate.effect)
    assert candidate.constant is not None
    return replace(point, freed=point.freed | {candidate.constant})


def removed(problem: Problem, point: Point, candidate: Candidate) -> Point:
    """Take a candidate out at a point."""
    if candidate.effect is not None:
        return point.without(candidate.name)
    assert candidate.constant is not None
    held = replace(point, freed=point.freed - {candidate.constant})
    low, high = (end * held.widths for end in problem.ends(held))
    return replace(held, shifts=np.clip(held.shifts, low, high))
