"""Rivals: explanations that were fitted in full, to be weighed by their evidence."""

from dataclasses import dataclass, replace

import numpy as np

from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.fit.polish import Polished, polished
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem


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


def larger(problem: Problem, rival: Rival, candidate: Candidate) -> Rival:
    """Give an explanation with one more, everything fitted anew."""
    point = added(rival.fit.point, candidate)
    return Rival((*rival.candidates, candidate), polished(problem, point))


def added(point: Point, candidate: Candidate) -> Point:
    """Put a candidate in at a point."""
    if candidate.effect is not None:
        return point.with_effect(candidate.effect)
    assert candidate.constant is not None
    return replace(point, freed=point.freed | {candidate.constant})
