"""Slow drift of a sensor, from sweeps in which nothing else moves.

The drift must not be fitted to the residual it is to judge, or it swallows the effect.
It is read off holds and off the differences between a sweep and its repeat.

References
----------
.. [1] D. A. Harville, "Maximum likelihood approaches to variance component estimation",
       J. Am. Stat. Assoc. 72(358), 320-338, 1977: restricted likelihood.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from gripperd.diagnose.noise.model import Noise
from gripperd.diagnose.noise.whitening import (
    Clock,
    clock_of,
    innovations,
    law_of,
)
from gripperd.model.track import Array

SIZES = (0.0002, 0.0005, 0.001, 0.0015, 0.002, 0.003)
"""Standard deviations tried, of full scale. [-]"""
MEMORIES = (8.0, 20.0, 60.0, 200.0)
"""Times of forgetting tried. [s]"""
ALLOWANCE = 0.001
"""Assumed when the recording has neither a hold nor a repeat, of full scale. [-]"""
PERSISTENCES = (0.5, 0.6, 0.7, 0.8, 0.9)
SHARES = (0.2, 0.4, 0.6, 0.8, 1.0)
"""Of the variance that persists so, tried. [-]"""
FAINTER, LASTING = 1 / 3, 60.0
"""Size of a drift beside a colour, of that without, and its memory. [-], [s]"""
PLENTY = 200
"""Samples from which a colour is told: it has two numbers more."""
PLAIN = 3.0
"""Log likelihood that must speak against the colour that neighbours tell. [nat]"""
CAUTION = 0.7
"""Share of the posterior below the size that is used: too little drift or wander makes
false alarms, too much only hides small effects. [-]"""


@dataclass(frozen=True)
class Quiet:
    """A stretch in which only the noise should move."""

    time: Array
    residual: Array
    regressors: Array
    """What else may move there, shape ``(n, k)``; always a constant."""
    loudness: float = 1.0
    """Standard deviation over that of a single reading: root 2 for differences."""

    @cached_property
    def clock(self) -> Clock:
        """Of its samples."""
        return clock_of(self.time)


def with_drift(noise: Noise, quiet: Sequence[Quiet], full_scale: float) -> Noise:
    """Add to a noise the drift that quiet stretches show.

    Parameters
    ----------
    noise
        Between neighbouring samples.
    quiet
        Holds, and differences of repeats.
    full_scale
        Largest reading. [unit of the noise]
    """
    if not quiet:
        return replace(noise, drift=ALLOWANCE * full_scale)
    tried = [
        replace(noise, drift=size * full_scale, memory=memory)
        for size in SIZES
        for memory in MEMORIES
    ]
    scores = np.array([sum(_likelihood(one, q) for q in quiet) for one in tried])
    weights = np.exp(scores - scores.max()).reshape(len(SIZES), len(MEMORIES))
    weights /= weights.sum()
    size = int(np.searchsorted(np.cumsum(weights.sum(1)), CAUTION))
    size = min(size, len(SIZES) - 1)
    memory = int(np.argmax(weights[size]))
    return replace(noise, drift=SIZES[size] * full_scale, memory=MEMORIES[memory])


def coloured(noise: Noise, quiet: Sequence[Quiet], most: float) -> Noise:
    """Give a noise the colour that quiet stretches show.

    Neighbours tell the difference of two readings, ``s² (1 - r)`` of an
    autoregressive noise that has not wandered yet. How far it wanders they cannot tell
    where it is covered by white noise; that is found by likelihood, with the difference
    of neighbours as it is.

    Parameters
    ----------
    noise
        With its drift: what that explains is no colour.
    quiet
        As of :func:`with_drift`.
    most
        Standard deviation above which what persists is no noise. [unit of the noise]
    """
    if sum(each.time.size for each in quiet) < PLENTY:
        return noise
    apart = noise.std**2 * (1 - noise.correlation)
    tried = [noise]
    for persistence in PERSISTENCES:
        for share in SHARES:
            r = share * persistence
            std = float(np.sqrt(apart / (1 - r)))
            tried.append(replace(noise, std=std, correlation=r, white=1 - share))
    scores = [max(_likelihoods(one, quiet)) for one in tried]
    scores[0] += PLAIN
    best = tried[int(np.argmax(scores))]
    if best is noise or best.std * (1 - best.white) ** 0.5 > most:
        return noise
    weights = np.exp(np.array(scores) - max(scores))
    order = np.argsort([one.slow_variance for one in tried])
    below = np.cumsum(weights[order]) / weights.sum()
    return tried[int(order[np.searchsorted(below, CAUTION)])]


def _likelihoods(noise: Noise, quiet: Sequence[Quiet]) -> Iterator[float]:
    """Of a colour with the drift that was found without it, and with a fainter one.

    What wanders fast is taken for a drift of short memory as long as there is nothing
    else to take it for.
    """
    for one in (noise, replace(noise, drift=FAINTER * noise.drift, memory=LASTING)):
        yield sum(_likelihood(one, each) for each in quiet)


def _likelihood(noise: Noise, quiet: Quiet) -> float:
    """Restricted log likelihood: what is left once the regressors are fitted."""
    louder = replace(
        noise, std=noise.std * quiet.loudness, drift=noise.drift * quiet.loudness
    )
    columns = np.column_stack([quiet.regressors, quiet.residual])
    law = law_of(quiet.clock, louder)
    white = innovations(columns, law)
    regressors, residual = white[:, :-1], white[:, -1]
    products = regressors.T @ regressors
    best = np.linalg.lstsq(regressors, residual, rcond=None)[0]
    rest = residual - regressors @ best
    volume = np.linalg.slogdet(products + 1e-12 * np.eye(products.shape[0]))[1]
    return float(-0.5 * rest @ rest - 0.5 * volume) - law.log_scale


def hold(time: Array, residual: Array, *, creeps: bool) -> Quiet:
    """Give a hold; under pressure the rubber may creep meanwhile."""
    since = time - time[0]
    ones = np.ones_like(since)
    regressors = [ones]
    if creeps:
        regressors += [np.log1p(since), np.exp(-since / 4)]
    return Quiet(time, residual, np.column_stack(regressors))


def repeat(time: Array, first: Array, second: Array, load: Array) -> Quiet:
    """Give the difference of a sweep and its repeat; a loss may scale with the load."""
    regressors = np.column_stack([np.ones_like(time), load])
    if np.ptp(load) < 1e-9 * (np.max(np.abs(load)) + 1e-300):
        regressors = regressors[:, :1]
    return Quiet(time, second - first, regressors, 2**0.5)


def shortened(quiet: Iterable[Quiet], most: int = 3000) -> list[Quiet]:
    """Keep the first samples of each stretch: a likelihood takes time."""
    return [
        Quiet(q.time[:most], q.residual[:most], q.regressors[:most], q.loudness)
        for q in quiet
    ]
