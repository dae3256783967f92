"""Residuals made independent: the innovations of the noise itself.

The noise is first-order autoregressive beside what is white and an Ornstein-Uhlenbeck
drift. Its Kalman filter turns residuals into innovations of unit variance; the filter
is linear and its gains do not depend on the values, so the same map serves every
column.

References
----------
.. [1] J. Durbin, S. J. Koopman, "Time Series Analysis by State Space Methods", 2nd
       ed., Oxford, 2012, section 7.2: prediction error decomposition.
"""

from typing import NamedTuple

import numpy as np

from gripperd.diagnose.noise.model import Noise
from gripperd.model.compiled import compiled
from gripperd.model.track import Array


def whitened(columns: Array, time: Array, noise: Noise) -> Array:
    """Map columns so that noise becomes independent with unit variance.

    Parameters
    ----------
    columns
        Shape ``(n, k)``, without NaN.
    time
        Of the samples, rising within a run, shape ``(n,)``. [s]
    noise
        Of the residual.

    Returns
    -------
    Innovations, shape ``(n, k)``. [-]
    """
    return innovations(columns, law_of(clock_of(time), noise))


class Clock(NamedTuple):
    """When samples were taken."""

    steps: Array
    """To each sample, in usual ones, shape ``(n,)``. [-]"""
    seconds: Array
    """The same. [s]"""


def clock_of(time: Array) -> Clock:
    """Give the clock of samples at some times, rising within a run. [s]."""
    step = np.diff(time, prepend=time[:1])
    usual = float(np.median(step[1:])) if step.size > 1 else 1.0
    return Clock(step / usual, step)


class Law(NamedTuple):
    """What the filter of a noise does at each sample."""

    kept: Array
    """Share that is left since the sample before, of what is neither white nor drift,
    and of the drift, shape ``(n, 2)``. [-]"""
    gains: Array
    """What each of the two learns of an innovation, shape ``(n, 2)``. [-]"""
    scales: Array
    """One by the standard deviation of each innovation, shape ``(n,)``."""
    log_scale: float
    """Sum of the log standard deviations of the innovations: the volume. [nat]"""


def law_of(clock: Clock, noise: Noise, ages: Array | None = None) -> Law:
    """Give the law of a noise.

    Parameters
    ----------
    clock
        Of the samples.
    noise
        Of the residual.
    ages
        Memories that its drift has been through by each sample, where it does not go by
        the clock, shape ``(n,)``. [-]
    """
    steps, seconds = clock
    aged = seconds / noise.memory if ages is None else np.diff(ages, prepend=ages[:1])
    slow = max(noise.drift, 1e-6 * noise.std)
    fast = noise.std * (1 - noise.white) ** 0.5
    sizes = fast, noise.persistence, slow, noise.std**2 * noise.white
    return Law(*compiled(_filter)(steps, aged, np.array(sizes)))


def innovations(columns: Array, law: Law) -> Array:
    """Map columns as :func:`whitened` does, by a law that is known already."""
    values = np.ascontiguousarray(columns)
    return compiled(_innovations)(values, law.kept, law.gains, law.scales)


def _innovations(columns: Array, kept: Array, gains: Array, scales: Array) -> Array:
    n, k = columns.shape
    out = np.empty((n, k))
    a = np.zeros(k)
    d = np.zeros(k)
    for i in range(n):
        f, g = kept[i]
        k1, k2 = gains[i]
        for j in range(k):
            a[j] *= f
            d[j] *= g
            innovation = columns[i, j] - a[j] - d[j]
            out[i, j] = innovation * scales[i]
            a[j] += k1 * innovation
            d[j] += k2 * innovation
    return out


def _filter(
    steps: Array, ages: Array, sizes: Array
) -> tuple[Array, Array, Array, float]:
    fast, persistence, slow, white = sizes
    kept, gains = np.ones((steps.size, 2)), np.empty((steps.size, 2))
    scales, total = np.empty(steps.size), 0.0
    p11, p12, p22 = fast * fast, 0.0, slow * slow
    for i in range(steps.size):
        if i > 0:
            skipped = max(1.0, np.round(steps[i]))
            f = persistence**skipped if persistence > 0 else 0.0
            g = np.exp(-ages[i])
            p11 = f * f * p11 + fast * fast * (1 - f * f)
            p12 = f * g * p12
            p22 = g * g * p22 + slow * slow * (1 - g * g)
            kept[i] = f, g
        variance = p11 + 2 * p12 + p22 + white
        k1, k2 = (p11 + p12) / variance, (p12 + p22) / variance
        gains[i] = k1, k2
        scales[i] = 1 / np.sqrt(variance)
        total += 0.5 * np.log(variance)
        p11, p12, p22 = (
            p11 - k1 * (p11 + p12),
            p12 - k1 * (p12 + p22),
            p22 - k2 * (p12 + p22),
        )
    return kept, gains, scales, total
