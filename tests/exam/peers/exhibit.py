"""What every method is shown: sweeps to learn from, sweeps to be judged by."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from gripperd.diagnose.diagnosis import Diagnosis
from gripperd.diagnose.fit.candidates import Candidate, candidates
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.effects import EFFECTS
from gripperd.model.track import Array


@dataclass(frozen=True)
class Exhibit:
    """One case after the front end: read, screened, smoothed, recalibrated.

    The front end is ours and the same for all; so no method stumbles over raw data.
    """

    train: Problem
    test: Problem
    point: Point
    """Constants refitted within their tolerances."""
    listed: Sequence[Candidate]
    """The library."""
    seed: int

    def remaining(self, explained: Sequence[Array]) -> dict[str, float]:
        """Root mean square left on the test, signal by signal. SI.

        Parameters
        ----------
        explained
            What a method adds to the recalibrated model, block by block of the test.
        """
        left: dict[str, list[Array]] = {}
        residuals = self.test.judged(self.point)
        for block, residual, part in zip(
            self.test.blocks, residuals, explained, strict=True
        ):
            left.setdefault(str(block.signal), []).append(residual - part)
        return {
            signal: float(np.sqrt(np.mean(np.concatenate(pieces) ** 2)))
            for signal, pieces in left.items()
        }


def shown(found: Diagnosis, seed: int) -> Exhibit:
    """Show others what our diagnosis was made of."""
    parts = found.split
    columns = {
        name for run in found.recording.runs for name in run.columns if run.has(name)
    }
    listed, _ = candidates(EFFECTS, parts.train, frozenset(columns))
    return Exhibit(parts.train, parts.test, found.recalibrated, listed, seed)


@dataclass(frozen=True, slots=True)
class Guess:
    """What a method says."""

    names: tuple[str, ...]
    """Effects, most certain first; empty when it names none."""
    families: frozenset[str]
    """Families it points at."""
    after: Mapping[str, float]
    """Root mean square on the test by signal. SI."""


class Method(Protocol):
    """Any way to find what is missing."""

    def __call__(self, exhibit: Exhibit) -> Guess:
        """Look at an exhibit.

        Raises
        ------
        ImportError
            When the package it stands on is not installed.
        """
