"""A fast wave in what is left: a valve that hunts, a frame that rings.

Ordinates of the periodogram of white noise are exponential, so the largest of n exceeds
g times their mean with a chance of about ``n exp(-g)``.

References
----------
.. [1] R. A. Fisher, "Tests of significance in harmonic analysis", Proc. R. Soc. A
       125(796), 54-59, 1929.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, exp, pi

import numpy as np
from scipy.fft import rfft, rfftfreq

from gripperd.diagnose.noise.model import Noise
from gripperd.model.track import Array

FASTEST_SWEEP = 0.04
"""Cycles a sample below which a wave may be what the sweep itself asks for. [-]"""
PERIODS = 10
"""Fewer of them in a sweep are no wave."""
LOUD = 8.0
"""Times the mean from which an ordinate is part of the wave. [-]"""
WHITE = 2.0
"""Mean ordinate of white noise of unit variance: half as many as there are samples
share the sum of their squares. [-]"""


@dataclass(frozen=True, slots=True)
class Ripple:
    """The clearest wave in one signal."""

    frequency: float
    """[Hz]"""
    p_value: float
    amplitude: float
    """Root mean square over all samples, in units of the signal."""


def ripple(white: Sequence[Array], times: Sequence[Array], noise: Noise) -> Ripple:
    """Look for a fast wave in whitened residuals of one signal.

    Parameters
    ----------
    white, times
        Of each sweep, shape ``(n,)``. [-], [s]
    noise
        By which they were whitened.
    """
    best, place, power, ordinates = 0.0, 0.0, 0.0, 0
    for left, time in zip(white, times, strict=True):
        cycles, density = _fast(left)
        if not density.size or density.mean() <= 0:
            continue
        ordinates += density.size
        over = density / density.mean()
        part = over > LOUD
        more = float((density[part] - WHITE).sum())
        power += more * _gain(noise, float(cycles[np.argmax(over)]))
        if over.max() > best:
            best = float(over.max())
            place = float(cycles[np.argmax(over)] / np.median(np.diff(time)))
    if not ordinates:
        return Ripple(0.0, 1.0, 0.0)
    samples = sum(left.size for left in white)
    return Ripple(
        place,
        min(1.0, ordinates * exp(-best)),
        (max(power, 0.0) / samples) ** 0.5,
    )


def _fast(left: Array) -> tuple[Array, Array]:
    """Cycles a sample and squares in units of the noise, the fast part."""
    if left.size < 3 * PERIODS:
        return np.empty(0), np.empty(0)
    # The periodogram of scipy.signal, which takes half a second to load.
    cycles = rfftfreq(left.size)
    density = WHITE / left.size * np.abs(rfft(left - left.mean())) ** 2
    fast = (cycles > max(FASTEST_SWEEP, PERIODS / left.size)) & (cycles < 0.5)
    return cycles[fast], density[fast]


def _gain(noise: Noise, cycles: float) -> float:
    """Power of a noise at a frequency, of white noise of unit variance."""
    r = noise.persistence
    wandering = (1 - r**2) / (1 + r**2 - 2 * r * cos(2 * pi * cycles))
    return noise.std**2 * (noise.white + (1 - noise.white) * wandering)
