"""How much a sensor scatters, learned from the samples themselves."""

from math import exp, pi, sqrt

TIME_CONSTANT = 5.0
"""Of the mean; long against a grasp, short against a shift. [s]"""
OUTLIER = 5.0
"""A change that is larger than so many usual ones counts as no more: it is a signal."""
PER_BEND = sqrt(pi / 12)
"""Sigma of white noise over the mean of ``|x0 - 2 x1 + x2|``, whose variance is 6 σ²
and whose mean is sqrt(2/π) of its own sigma. [-]"""


class Noise:
    """One sigma of one sensor, never below what its span makes likely.

    Second differences are taken, so that neither a value nor a steady rise counts.

    Parameters
    ----------
    floor
        Least sigma to assume, in the unit of the sensor.
    """

    def __init__(self, floor: float) -> None:
        self._floor = floor
        self._bend = floor / PER_BEND
        self._past: tuple[float, ...] = ()

    @property
    def sigma(self) -> float:
        """Standard deviation, in the unit of the sensor."""
        return max(self._floor, PER_BEND * self._bend)

    def update(self, value: float | None, dt: float) -> None:
        """Take in one more sample, None for a gap; dt since the one before. [s]."""
        if value is None:
            self._past = ()
            return
        if len(self._past) == 2:
            first, second = self._past
            usual = max(self._bend, self._floor / PER_BEND)
            bend = min(abs(first - 2 * second + value), OUTLIER * usual)
            self._bend += (bend - self._bend) * (1.0 - exp(-dt / TIME_CONSTANT))
        self._past = (*self._past[-1:], value)
