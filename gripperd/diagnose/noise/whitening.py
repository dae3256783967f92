"""Residuals made independent: the innovations of the noise itself.

The noise is first-order autoregressive plus an Ornstein-Uhlenbeck drift. Its Kalman
filter turns residuals into innovations of unit variance; the filter is linear and its
gains do not depend on the values, so the same map serves every column.

References
----------
.. [1] J. Durbin, S. J. Koopman, "Time Series Analysis by State Space Methods", 2nd
       ed., Oxford, 2012, section 7.2: prediction error decomposition.
"""

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
    return innovations(columns, *law_of(time, noise))


def law_of(time: Array, noise: Noise) -> tuple[Array, Array]:
    """Steps between the samples, and what :func:`innovations` needs of the noise."""
    step = np.diff(time, prepend=time[:1])
    usual = float(np.median(step[1:])) if step.size > 1 else 1.0
    slow = max(noise.drift, 1e-6 * noise.std)
    return step, np.array([noise.std, noise.correlation, usual, slow, noise.memory])


def innovations(columns: Array, step: Array, law: Array) -> Array:
    """Map columns as :func:`whitened` does, by a law that is known already."""
    return compiled(_innovations)(np.ascontiguousarray(columns), step, law)


def _innovations(columns: Array, step: Array, law: Array) -> Array:
    fast, correlation, usual, slow, memory = law
    n, k = columns.shape
    out = np.empty((n, k))
    a = np.zeros(k)
    d = np.zeros(k)
    p11, p12, p22 = fast * fast, 0.0, slow * slow
    for i in range(n):
        if i > 0:
            skipped = step[i] / usual
            f = correlation ** max(1.0, np.round(skipped)) if correlation > 0 else 0.0
            g = np.exp(-step[i] / memory)
            p11 = f * f * p11 + fast * fast * (1 - f * f)
            p12 = f * g * p12
            p22 = g * g * p22 + slow * slow * (1 - g * g)
            for j in range(k):
                a[j] *= f
                d[j] *= g
        variance = p11 + 2 * p12 + p22
        k1, k2 = (p11 + p12) / variance, (p12 + p22) / variance
        scale = 1 / np.sqrt(variance)
        for j in range(k):
            innovation = columns[i, j] - a[j] - d[j]
            out[i, j] = innovation * scale
            a[j] += k1 * innovation
            d[j] += k2 * innovation
        p11, p12, p22 = (
            p11 - k1 * (p11 + p12),
            p12 - k1 * (p12 + p22),
            p22 - k2 * (p12 + p22),
        )
    return out


def log_scale(time: Array, noise: Noise) -> float:
    """Sum of the log standard deviations of the innovations: the volume. [nat]."""
    return compiled(_log_scales)(*law_of(time, noise))


def _log_scales(step: Array, law: Array) -> float:
    fast, correlation, usual, slow, memory = law
    total = 0.0
    p11, p12, p22 = fast * fast, 0.0, slow * slow
    for i in range(step.size):
        if i > 0:
            skipped = max(1.0, np.round(step[i] / usual))
            f = correlation**skipped if correlation > 0 else 0.0
            g = np.exp(-step[i] / memory)
            p11 = f * f * p11 + fast * fast * (1 - f * f)
            p12 = f * g * p12
            p22 = g * g * p22 + slow * slow * (1 - g * g)
        variance = p11 + 2 * p12 + p22
        k1, k2 = (p11 + p12) / variance, (p12 + p22) / variance
        total += 0.5 * np.log(variance)
        p11, p12, p22 = (
            p11 - k1 * (p11 + p12),
            p12 - k1 * (p12 + p22),
            p22 - k2 * (p12 + p22),
        )
    return total
