"""How far simulation and measurement are apart on what took no part in the fit.

References
----------
.. [1] P. Hall, J. L. Horowitz, B.-Y. Jing, "On blocking rules for the bootstrap with
       dependent data", Biometrika 82(3), 561-574, 1995.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from gripperd.diagnose.residuals.dead_band import UNIFORM
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.residuals.ranges import ranges
from gripperd.model.effect import Signal
from gripperd.model.track import Array

STRETCH = 40
"""Samples that are drawn together, longer than the noise remembers."""
PIECES = 8
"""Of a few samples as many are drawn at least, be they shorter."""
DRAWS = 400
"""Of the bootstrap."""
WORSE = 1.01
"""Gap over that of better constants alone from which effects do harm. [-]"""
OPEN = 1.1
"""Gap that better constants leave, over the noise floor, from which there is something
to close: floors are known to a tenth. [-]"""
REACHED = 1.3
"""Gap over the noise floor up to which nothing more can be asked. [-]"""
LEAST_CLOSED = 0.45
"""Share of a gap well above the noise that effects close at least. [-]"""
SOME_CLOSED = 0.3
"""The same where they reach what can be asked, for most of it was reached without. [-]
"""
DRIFTS = 0.006
"""How far a sound sensor is off in a sweep, of full scale: common ones drift by 0.2 %
(sd), and seldom by three times that. [-]"""
CROWD = 2
"""More effects at once are held to the two limits that follow, constants alone to the
latter, unless it is their tolerances that are wrong."""
CLOSELY, MOST_CLOSED = 1.15, 0.85


@dataclass(frozen=True, slots=True)
class Gap:
    """Root mean square of measured minus predicted, of one signal. SI."""

    signal: Signal
    before: float
    """With the model as it came."""
    recalibrated: float
    """With the best constants alone."""
    after: float
    """With the effects."""
    noise_floor: float
    """Repeatability of the measurement itself, inputs of the prediction included."""
    ci95_after: tuple[float, float]
    """Interval that holds ``after`` with 95 %, by a block bootstrap [1]_."""
    in_band: float = 0.0
    """What nobody foretells beside it: where a regulator rests in its band."""

    @property
    def reachable(self) -> float:
        """What the best model can reach: the noise floor, and what nobody foretells."""
        return float(np.hypot(self.noise_floor, self.in_band))

    @property
    def closed(self) -> float:
        """Share of the mean square above the noise that recalibration left. [-]."""
        floor = self.reachable**2
        left = self.recalibrated**2 - floor
        return 1 - (self.after**2 - floor) / left if left > 0 else 0.0

    @property
    def left_open(self) -> float:
        """What better constants alone leave, over what can be reached. [-]."""
        return self.recalibrated / self.reachable

    @property
    def is_open(self) -> bool:
        """Whether better constants alone leave more than noise."""
        return self.left_open > REACHED

    @property
    def is_spoilt(self) -> bool:
        """Whether effects leave a signal far worse than its noise and constants do."""
        least = max(self.recalibrated, self.reachable)
        return self.ci95_after[0] > REACHED * least

    def confirms(self, effects: int, *, exact: bool = False) -> bool:
        """Whether what took no part bears so many effects out.

        A crowd of effects can imitate one that no library holds, but not closely. What
        has no form that could be wrong, as a constant has none, closes what it is. What
        is worse by no more than chance, where nothing was left to close, says nothing;
        where something was, a name closes some of it. Where a regulator sleeps a few
        rests weigh as much as all that moves, and are off by chance.
        """
        if self.in_band:
            return not self.is_spoilt
        if self.ci95_after[0] > WORSE * max(self.recalibrated, self.reachable):
            return False
        if self.left_open > OPEN and self.after >= self.recalibrated:
            return False
        if self.left_open > REACHED and self.closed < SOME_CLOSED:
            return False
        crowd = effects > CROWD
        reached = self.after <= (CLOSELY if crowd else REACHED) * self.reachable
        least = MOST_CLOSED if crowd or exact else LEAST_CLOSED
        return reached or self.closed >= least


def gaps(
    test: Problem,
    points: Sequence[Point],
    rng: np.random.Generator,
) -> dict[Signal, Gap]:
    """Judge three points by sweeps that were left out.

    Parameters
    ----------
    test
        The sweeps that were left out.
    points
        The model as it came, with the best constants, and with the effects.
    rng
        For the interval.
    """
    before, recalibrated, after = (by_signal(test, point) for point in points)
    return {
        signal: Gap(
            signal,
            _rms(before[signal]),
            _rms(recalibrated[signal]),
            _rms(after[signal]),
            test.floor(signal),
            _interval(after[signal], rng),
            UNIFORM * test.band if signal is Signal.PRESSURE else 0.0,
        )
        for signal in after
    }


def beside_drift(test: Problem, point: Point) -> dict[Signal, float]:
    """Root mean square of each signal, but for the drift of its sensor. [SI].

    Of each sweep as much is taken off as a sound sensor may have drifted by then.

    Parameters
    ----------
    test
        The sweeps that were left out.
    point
        The model.
    """
    found: dict[Signal, list[Array]] = {}
    scales = ranges(test)
    for block, residual in zip(test.blocks, test.judged(point), strict=True):
        most = DRIFTS * scales[block.signal]
        steady = residual - np.clip(np.mean(residual), -most, most)
        found.setdefault(block.signal, []).append(steady)
    return {signal: _rms(np.concatenate(pieces)) for signal, pieces in found.items()}


def by_signal(problem: Problem, point: Point) -> dict[Signal, Array]:
    """Residuals of each signal, in order of time. [SI]."""
    found: dict[Signal, list[Array]] = {}
    for block, residual in zip(problem.blocks, problem.judged(point), strict=True):
        found.setdefault(block.signal, []).append(residual)
    return {signal: np.concatenate(pieces) for signal, pieces in found.items()}


def _rms(residual: Array) -> float:
    return float(np.sqrt(np.mean(residual**2)))


def _interval(residual: Array, rng: np.random.Generator) -> tuple[float, float]:
    count = max(residual.size // STRETCH, min(residual.size, PIECES))
    means = np.array([np.mean(piece**2) for piece in np.array_split(residual, count)])
    drawn = means[rng.integers(0, count, (DRAWS, count))].mean(1)
    low, high = np.sqrt(np.quantile(drawn, (0.025, 0.975)))
    return float(low), float(high)
