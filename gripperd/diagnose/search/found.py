"""What a search found."""

from dataclasses import dataclass

from gripperd.diagnose.fit.rival import Rival
from gripperd.diagnose.residuals.problem import Problem
from gripperd.model.track import Array


@dataclass(frozen=True)
class Found:
    """Outcome of the search."""

    problem: Problem
    """The recording and the model, with the noise that explanations were judged by."""
    null: Rival
    """The best constants alone."""
    best: Rival
    """The simplest explanation that no larger one beats by its price."""
    rivals: tuple[Rival, ...]
    """All that were fitted in full, best first."""
    threshold: float
    """Gain that noise alone reaches in one recording of a hundred, and the least that
    an effect beside others is believed for. [nat]"""
    gains: dict[str, float]
    """Gain of each name alone, linear. [nat]"""
    faint: tuple[str, ...]
    """Names that leave no trace in this recording."""
    nulls: Array
    """Gains in recordings without a discrepancy, shape ``(n,)``. [nat]"""
