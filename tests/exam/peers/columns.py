"""Our linearised effects as columns, for methods that choose among columns.

The columns are whitened by the noise our engine identified, and what constants within
their tolerance explain is taken out: the best that can be handed to a selector.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.residuals.response import responses, sensitivities
from gripperd.model.track import Array
from tests.exam.peers.exhibit import Exhibit

FAINT = 1e-6
"""Part of a column that constants leave, below which it is one of them. [-]"""


@dataclass(frozen=True)
class Columns:
    """Everything that could explain the training sweeps, linear."""

    exhibit: Exhibit
    owners: tuple[tuple[Candidate, int], ...]
    """Candidate of each column, and which of its amplitudes."""
    constants: Array
    """Whitened, for one sigma each, with their priors below; shape ``(n + k, k)``."""
    effects: Array
    """Whitened, zeros below; shape ``(n + k, m)``."""
    target: Array
    """Whitened residual, with the pull of the priors below; shape ``(n + k,)``."""

    @cached_property
    def free(self) -> tuple[Array, Array, NDArray[np.bool_]]:
        """Unit columns and target free of the constants, and which columns are seen."""
        basis, _ = np.linalg.qr(self.constants)
        rest = self.effects - basis @ (basis.T @ self.effects)
        lengths = np.linalg.norm(rest, axis=0)
        seen = lengths > FAINT * np.linalg.norm(self.effects, axis=0)
        target = self.target - basis @ (basis.T @ self.target)
        return rest / np.where(seen, lengths, np.inf), target, seen

    def explained(self, chosen: Sequence[int]) -> list[Array]:
        """Fit some columns beside the constants and give what they add to the test."""
        matrix = np.column_stack([self.constants, self.effects[:, list(chosen)]])
        best = np.linalg.lstsq(matrix, self.target, rcond=None)[0]
        test, point = self.exhibit.test, self.exhibit.point
        known = sensitivities(test, point)
        for place in chosen:
            candidate, amplitude = self.owners[place]
            assert candidate.effect is not None
            known.append(responses(test, point, candidate.effect)[amplitude])
        total = [np.zeros_like(values) for values in test.measured]
        for factor, response in zip(best.tolist(), known, strict=True):
            for part, column in zip(total, response, strict=True):
                part += factor * column
        return total


def columns(exhibit: Exhibit) -> Columns:
    """Evaluate and whiten all columns."""
    train, point = exhibit.train, exhibit.point
    owners, found = [], []
    for candidate in exhibit.listed:
        if candidate.effect is None:
            continue
        for amplitude, response in enumerate(responses(train, point, candidate.effect)):
            owners.append((candidate, amplitude))
            found.append(response)
    constants = sensitivities(train, point)
    count = len(constants)
    white = _white(train, [*constants, *found, train.residuals(point)])
    below = np.zeros((count, white.shape[1]))
    below[:, :count] = np.eye(count)
    below[:, -1] = -point.shifts
    table = np.concatenate([white, below])
    return Columns(
        exhibit, tuple(owners), table[:, :count], table[:, count:-1], table[:, -1]
    )


def _white(problem: Problem, responses: Sequence[Sequence[Array]]) -> Array:
    return np.concatenate(
        [
            problem.white([response[index] for response in responses], index)
            for index in range(len(problem.blocks))
        ]
    )
