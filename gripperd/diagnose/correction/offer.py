"""What is left and nobody can name, as a smooth function: no physics, and fenced.

A Gaussian process of the quantities that a stage depends on, learnt from the sweeps
that were searched and judged on those that were not. What wanders inside a sweep and
does not come again at the same place is told apart from it: it would be no correction.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from gripperd.diagnose.correction.gaussian_process import (
    LENGTHS,
    Process,
    Samples,
    likeliest,
)
from gripperd.diagnose.noise.model import Noise
from gripperd.diagnose.readings.columns import Column
from gripperd.diagnose.residuals.holdout import Split
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.residuals.regressors import inputs, listed, ranges, varied
from gripperd.diagnose.verdict.gap import STRETCH, by_signal
from gripperd.model.effect import Signal
from gripperd.model.track import Array

MOST = 400
"""Samples from which lengths are learnt; the cost grows with their cube."""
FENCE = 0.5
"""Posterior over prior variance above which a correction gives nothing. [-]"""
MARGIN = 0.02
"""How far it reaches beyond what was measured, of the range. [-]"""
ENDLESS = 0.99
"""Share of the longest length from which nothing depends on a quantity. [-]"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Correction:
    """A smooth function to be added to the prediction of one signal. SI."""

    signal: Signal
    regressors: tuple[Column, ...]
    process: Process
    usual: Array
    """Median of each regressor, shape ``(k,)``."""
    spread: Array
    """Unit of each regressor inside the process, shape ``(k,)``."""
    ends: Array
    """Lowest and highest of each regressor, shape ``(2, k)``."""
    held: Mapping[Column, tuple[float, float]]
    """Lowest and highest of what was measured and is no regressor: it did not vary, or
    was not measured everywhere."""
    wander: float
    """Standard deviation of what does not come again at the same place."""

    @property
    def amplitude(self) -> float:
        """Standard deviation of the function where nothing is known."""
        return self.process.kernel.amplitude

    @property
    def lengths(self) -> tuple[float | None, ...]:
        """Way along each regressor over which it changes; none where it does not."""
        return tuple(
            float(length * unit) if length < ENDLESS * LENGTHS[1] else None
            for length, unit in zip(
                self.process.kernel.lengths, self.spread, strict=True
            )
        )

    @property
    def reach(self) -> Array:
        """Ends of the fence along each regressor, shape ``(2, k)``."""
        margin = MARGIN * np.ptp(self.ends, axis=0)
        return np.asarray(self.ends + np.array([[-1.0], [1.0]]) * margin)

    def std(self, regressors: Array) -> Array:
        """Standard deviation of the correction as the data leave it, shape ``(n,)``."""
        doubt = np.maximum(self.process.doubt(self._scaled(regressors)), 0.0)
        return np.asarray(self.amplitude * np.sqrt(doubt))

    def at(self, regressors: Array) -> Array:
        """Give the correction, NaN outside the fence.

        Parameters
        ----------
        regressors
            In their order, shape ``(n, k)``. [SI]
        """
        low, high = self.reach
        seen = (regressors >= low) & (regressors <= high)
        scaled = self._scaled(regressors)
        known = seen.all(1) & (self.process.doubt(scaled) <= FENCE)
        return np.where(known, self.process.mean(scaled), np.nan)

    def _scaled(self, regressors: Array) -> Array:
        return np.asarray((regressors - self.usual) / self.spread)


@dataclass(frozen=True, slots=True)
class Worth:
    """What a correction is worth on sweeps that took no part. SI."""

    without: float
    """Root mean square of what better constants leave."""
    corrected: float
    """The same with the correction."""
    gain: float
    """Mean square it takes away, of better constants or nearest effects."""
    std: float
    """Standard error of the gain."""
    inside: float
    """Share of samples inside the fence. [0..1]"""


@dataclass(frozen=True, slots=True)
class Offer:
    """A correction that is of use."""

    correction: Correction
    worth: Worth


def offers(
    parts: Split, signals: Iterable[Signal], base: Point, nearest: Point
) -> Iterator[Offer]:
    """Learn what is left, and offer what beats every explanation on held-out sweeps.

    Parameters
    ----------
    parts
        What a correction is learnt from, and what it is judged on.
    signals
        Those with something left.
    base
        The model with the best constants, which a correction is added to.
    nearest
        The same with the effects that come nearest.
    """
    for signal in signals:
        train, test = (_of(part, signal) for part in (parts.train, parts.test))
        if not train.blocks or not test.blocks:
            continue
        if chosen := varied(train, test, listed(train, signal)):
            found = _learnt(train, signal, chosen, base)
            left, rival = (by_signal(test, point)[signal] for point in (base, nearest))
            worth = _worth(left, rival, found.at(inputs(test, chosen)))
            if worth.gain > worth.std:
                yield Offer(found, worth)


def _of(problem: Problem, signal: Signal) -> Problem:
    return replace(problem, noises={signal: problem.noises[signal]})


def _learnt(
    train: Problem, signal: Signal, regressors: tuple[Column, ...], base: Point
) -> Correction:
    measured = inputs(train, regressors)
    usual, spread = np.median(measured, axis=0), np.std(measured, axis=0)
    scaled = (measured - usual) / spread
    residuals = train.residuals(base)
    outcome = np.concatenate(residuals)
    some = np.unique(np.linspace(0, outcome.size - 1, MOST).round().astype(np.intp))
    noise = train.noises[signal]
    kernel, wander = likeliest(
        Samples(scaled[some], outcome[some], *_covariances(train, noise, some)),
        train.processes,
    )
    # Nearly unrelated samples taught the wander; here it weighs on their neighbours.
    slow = replace(noise, drift=float(np.hypot(noise.drift, wander)))
    white = _whitened(
        replace(train, noises={signal: slow}),
        np.column_stack([outcome, kernel.between(scaled, scaled[some])]),
    )
    return Correction(
        signal=signal,
        regressors=regressors,
        process=Process.given(kernel, scaled[some], white[:, 1:], white[:, 0]),
        usual=usual,
        spread=spread,
        ends=np.array([measured.min(0), measured.max(0)]),
        held=ranges(train, [x for x in listed(train, signal) if x not in regressors]),
        wander=wander,
    )


def _whitened(problem: Problem, columns: Array) -> Array:
    """Whiten columns over all blocks, sweep by sweep."""
    cuts = np.cumsum([time.size for time in problem.times])[:-1]
    return np.concatenate(
        [
            problem.white(list(piece.T), index)
            for index, piece in enumerate(np.split(columns, cuts))
        ]
    )


def _covariances(
    problem: Problem, noise: Noise, some: NDArray[np.intp]
) -> tuple[Array, Array]:
    """Of the noise, and the correlation of what wanders inside a sweep.

    Sweeps may be sampled at rates of their own. A power of the time apart, not rounded
    to whole samples, is a covariance wherever they lie.
    """
    times = problem.times
    sizes = [one.size for one in times]
    sweep = np.repeat(np.arange(len(times)), sizes)[some]
    step = np.repeat([float(np.median(np.diff(one))) for one in times], sizes)[some]
    time = np.concatenate(times)[some]
    apart = np.abs(np.subtract.outer(time, time))
    same = np.equal.outer(sweep, sweep)
    wander = same * np.exp(-apart / noise.memory)
    fast = same * noise.correlations(apart / step)
    return noise.std**2 * fast + noise.drift**2 * wander, wander


def _worth(left: Array, rival: Array, given: Array) -> Worth:
    """Judge on sweeps left out; outside its fence a correction is 0."""
    inside = np.isfinite(given)
    corrected = left - np.where(inside, given, 0.0)
    best = min(left, rival, key=lambda one: float(np.mean(one**2)))
    count = max(left.size // STRETCH, 2)
    taken = np.array_split(best**2 - corrected**2, count)
    gains = [float(np.mean(piece)) for piece in taken]
    return Worth(
        without=float(np.sqrt(np.mean(left**2))),
        corrected=float(np.sqrt(np.mean(corrected**2))),
        gain=float(np.mean(best**2 - corrected**2)),
        std=float(np.std(gains, ddof=1) / np.sqrt(count)),
        inside=float(np.mean(inside)),
    )
