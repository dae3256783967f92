"""Methods that learn the residual and know no physics."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from gripperd.model.track import Array
from tests.exam.peers.classes import family
from tests.exam.peers.exhibit import Exhibit, Guess
from tests.exam.peers.features import Sheet, sheets

EVERY = 4
"""One sweep in so many validates a correction; fewer where there are fewer."""
WORTH = 0.02
"""Fall of the validated residual from which a correction is kept. [-]"""
SHUFFLES = 5


class Regressor(Protocol):
    """As in scikit-learn."""

    def fit(self, inputs: Array, outcome: Array) -> object:
        """Learn, from shapes ``(n, k)`` and ``(n,)``."""

    def predict(self, inputs: Array) -> Array:
        """Predict, shape ``(n,)``."""


@dataclass(frozen=True)
class Correction:
    """What was learnt of one signal."""

    gain: float
    """Share of the residual that goes on sweeps that took no part. [-]"""
    family: str
    explained: Array
    """On the test. [SI]"""


def corrected(exhibit: Exhibit, make: Callable[[int], Regressor]) -> Guess:
    """Learn every residual, keep what helps, and name by what it leans on.

    Parameters
    ----------
    exhibit
        The case.
    make
        Gives a new regressor for a seed.
    """
    kept: dict[str, Correction] = {}
    for signal, train, test in sheets(exhibit):
        correction = _learnt(signal, train, test, make(exhibit.seed), exhibit.seed)
        if correction.gain > WORTH:
            kept[signal] = correction
    names = [max(kept.values(), key=lambda one: one.gain).family] if kept else []
    return Guess((), frozenset(names), exhibit.remaining(_by_block(exhibit, kept)))


def _learnt(
    signal: str, train: Sheet, test: Sheet, regressor: Regressor, seed: int
) -> Correction:
    from sklearn.inspection import permutation_importance

    # Whole sweeps, in the order of the recording.
    sweeps, order = np.unique(train.course, return_inverse=True)
    every = min(EVERY, sweeps.size)
    out = order % every == every - 1
    if sweeps.size == 1:
        return Correction(0.0, "", np.zeros_like(test.residual))
    scale = float(np.std(train.residual[~out])) or 1.0
    regressor.fit(train.inputs[~out], train.residual[~out] / scale)
    left = train.residual[out] - scale * regressor.predict(train.inputs[out])
    gain = 1 - float(np.sqrt(np.mean(left**2) / np.mean(train.residual[out] ** 2)))
    if gain <= WORTH:
        return Correction(gain, "", np.zeros_like(test.residual))
    importance = permutation_importance(
        regressor,
        train.inputs[out],
        train.residual[out] / scale,
        scoring=_score,
        n_repeats=SHUFFLES,
        random_state=seed,
    ).importances_mean
    leans = dict(zip(train.variables, importance.tolist(), strict=True))
    explained = scale * regressor.predict(test.inputs)
    return Correction(gain, family(signal, leans), explained)


def _score(regressor: Regressor, inputs: Array, outcome: Array) -> float:
    return -float(np.mean((outcome - regressor.predict(inputs)) ** 2))


def _by_block(exhibit: Exhibit, kept: dict[str, Correction]) -> list[Array]:
    """Cut the corrections of the signals into blocks of the test."""
    taken = dict.fromkeys(kept, 0)
    blocks = []
    for block, measured in zip(exhibit.test.blocks, exhibit.test.measured, strict=True):
        signal = str(block.signal)
        if signal not in kept:
            blocks.append(np.zeros_like(measured))
            continue
        start = taken[signal]
        taken[signal] = start + measured.size
        blocks.append(kept[signal].explained[start : taken[signal]])
    return blocks
