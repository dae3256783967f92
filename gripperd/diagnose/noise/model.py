"""Noise of a column: what neighbouring samples cannot know of each other.

References
----------
.. [1] J. von Neumann et al., "The mean square successive difference", Ann. Math.
       Statist. 12(2), 153-162, 1941: variance that slow trends do not touch.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from gripperd.model.track import Array

CONSISTENT = 1.4826
"""Median absolute deviation to standard deviation, for a normal law."""
LONG = 8
"""Samples, for each of a lag, beyond which a piece tells the spread over it; of any lag
where none is so long. Then a correlation of 0.6 is found as 0.50 to 0.58."""
SHORT = 3
"""The same over one sample, where no piece is long."""


@dataclass(frozen=True, slots=True)
class Noise:
    """First-order autoregressive noise, white noise, and a slow drift."""

    std: float
    """Of one sample, without the drift. [unit of the column]"""
    correlation: float
    """Between neighbouring samples, without the drift. [-]"""
    drift: float = 0.0
    """Standard deviation of the drift. [unit of the column]"""
    memory: float = 20.0
    """Time in which the drift forgets. [s]"""
    white: float = 0.0
    """Share of the variance, without the drift, that no other sample has. [-]"""

    @property
    def persistence(self) -> float:
        """Share of what is not white that the next sample still has. [-]."""
        return self.correlation / (1 - self.white)

    @property
    def slow_variance(self) -> float:
        """Variance of one sample as a mean over many samples sees it."""
        return self.std**2 * (1 + 2 * self.correlation / (1 - self.persistence))

    @property
    def lasting(self) -> float:
        """Times louder a mean over many samples hears it than one reading. [-]."""
        return self.slow_variance**0.5 / self.std if self.std > 0 else 1.0

    def correlations(self, lags: Array) -> Array:
        """Between samples that many apart, without the drift. [-]."""
        alike = (1 - self.white) * self.persistence ** np.abs(lags)
        return np.asarray(np.where(lags == 0, 1.0, alike))

    @property
    def floor(self) -> float:
        """Standard deviation of one sample with the drift: repeatability."""
        return float(np.hypot(self.std, self.drift))


def quieter(one: Noise, other: Noise) -> Noise:
    """Give that of two noises which a mean over many samples hears less of."""
    return one if one.slow_variance < other.slow_variance else other


def quick_noise(
    pieces: Iterable[Array], step: float = 0.0, shortest: int = SHORT
) -> Noise:
    """Standard deviation and correlation of neighbours, from differences.

    With ``v_k`` half the mean square of differences over k samples, first-order
    autoregressive noise has ``v_1 = s²(1-r)`` and ``v_2 = s²(1-r²)``, so
    ``r = v_2/v_1 - 1``. Signals that are smooth over three samples leave no trace, for
    second differences are used where first ones would see their slope. Pieces that are
    all short tell ``v_1`` alone, and the noise is taken for white.

    Parameters
    ----------
    pieces
        Columns of runs, shape ``(n,)`` each, in order of time.
    step
        Of the converter that gave them, see :func:`coarse_step`. [unit of the column]
    shortest
        Samples beyond which a piece tells where none is long. Of a few settled points
        the set points would be taken for noise, unless a model has taken them off.
    """
    pieces = [piece[np.isfinite(piece)] for piece in pieces]
    v1, v2, v3 = (_spread(pieces, lag, step, LONG * lag) for lag in (1, 2, 3))
    if not any(piece.size > LONG for piece in pieces):
        v1 = _spread(pieces, 1, step, shortest)
    elif not any(piece.size > 2 * LONG for piece in pieces):
        v2, v3 = (_spread(pieces, lag, step, LONG) for lag in (2, 3))
    if v1 <= 0:
        return Noise(_resolution(pieces), 0.0)
    r = float(np.clip(v2 / v1 - 1, 0.0, 0.9))
    # A slope or a wander in the signal shows as growth beyond the law of lag 2.
    growth = v3 / v1
    if growth > (1 - r**3) / (1 - r) * 1.3:
        r = min(r, 0.3)
    most = _most(np.concatenate(pieces), r)
    variance = min(v1 / (1 - r), max(v1, most))
    return Noise(float(np.sqrt(variance)), 1 - v1 / variance)


def _most(values: Array, r: float) -> float:
    """Variance of a noise than which all of it together is no quieter.

    Differences tell little of it when neighbours are much alike. The mean square of n
    samples has a relative standard error of ``sqrt(2/n (1+r²)/(1-r²))``.
    """
    error = np.sqrt(2 / values.size * (1 + r**2) / (1 - r**2))
    return float(np.mean(values**2) * (1 + 2 * error))


def coarse_step(pieces: Iterable[Array]) -> float:
    """Step of a converter so coarse that its readings come again and again; 0 if none.

    Neighbours need not repeat: on a slope of one step a sample none do, and yet the
    differences tell next to nothing of the noise.

    Parameters
    ----------
    pieces
        Readings of runs as they came, shape ``(n,)`` each, in order of time.
    """
    every = np.concatenate([np.empty(0), *pieces])
    levels, counts = np.unique(every[np.isfinite(every)], return_counts=True)
    again = counts > 1
    if again.sum() < 2 or counts[again].sum() < 0.5 * counts.sum():
        return 0.0
    return float(np.diff(levels[again]).min())


def _spread(pieces: list[Array], lag: int, step: float, beyond: int) -> float:
    """Half the mean square of differences over a lag, robust, without their trend."""
    found: list[Array] = []
    for piece in pieces:
        if piece.size > beyond:
            change = piece[lag:] - piece[:-lag]
            few = piece.size <= LONG
            found.append(_few(change) if few else change - _running_median(change))
    if not found:
        return 0.0
    changes = np.concatenate(found)
    limit = 4 * max(CONSISTENT * float(np.median(np.abs(changes))), step)
    inside = changes[np.abs(changes) <= limit] if limit > 0 else changes
    return float(np.mean(inside**2)) / 2


def _few(change: Array) -> Array:
    """Take their mean off a few differences of neighbours, and make up for that.

    Of white noise their mean square is less by its share ``1/m²``: the mean is but the
    difference of both ends over m. A median would take most of one of three.
    """
    return np.asarray((change - change.mean()) / np.sqrt(1 - 1 / change.size**2))


def _running_median(values: Array, width: int = 25) -> Array:
    if values.size <= width:
        return np.full_like(values, np.median(values))
    windows = np.lib.stride_tricks.sliding_window_view(values, width)
    middle = np.median(windows, axis=1)
    pad = width // 2
    return np.pad(middle, (pad, values.size - middle.size - pad), mode="edge")


def _resolution(pieces: list[Array]) -> float:
    """Half a step of the converter over root 3, when nothing else is seen."""
    values = np.unique(np.concatenate(pieces)) if pieces else np.empty(0)
    steps = np.diff(values)
    steps = steps[steps > 0]
    return float(steps.min() / np.sqrt(12)) if steps.size else 0.0
