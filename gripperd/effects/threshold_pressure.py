"""Threshold: pressure spent on stretching the bladder before the braid carries.

References
----------
.. [1] B. Tondu, "Modelling of the McKibben artificial muscle: a review", J. Intell.
       Mater. Syst. Struct. 23(3), 225-253, 2012, eq. (23).
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gripperd.model.effect import MuscleState
from gripperd.model.kinds import InMuscle
from gripperd.model.muscle import Muscle
from gripperd.model.parameter import amplitude, shape
from gripperd.model.real import Real, positive_part


@dataclass(frozen=True, slots=True)
class ThresholdPressure(InMuscle):
    r"""A dead zone of the ideal pull in pressure, with sharp or rounded ends.

    .. math:: F = -g(p) A(h), \quad g = c \ln
              \frac{\cosh\frac{p + p_0}{2c}}{\cosh\frac{p - p_0}{2c}}

    For ``c = 0`` that is p cut off at ``±p0``. Under pressure ``p - g`` is close to the
    softplus of ``p - p0``, but g is odd in p: a vented muscle has no pull, and without
    a threshold there is no effect.
    """

    name: ClassVar[str] = "threshold_pressure"
    needs: ClassVar[frozenset[str]] = frozenset({"force", "pressure", "contraction"})
    shows: ClassVar[str] = (
        "the force starts late: above a threshold the muscle pulls less than the model"
        " says, by as much as that pressure would pull, at every length"
    )
    confused_with: ClassVar[tuple[str, ...]] = (
        "pressure_sensor_bias", "valve_offset", "ambient_pressure",
        "nonlinear_elasticity",
    )  # fmt: skip
    remedy: ClassVar[str] = "raise the pressure by the threshold"

    pressure: float = amplitude(unit="kPa", scale=20e3, low=0.0, high=400e3)
    """Threshold, p0. [Pa]"""
    softness: float = shape(unit="kPa", starts=(0.0, 10e3, 40e3), low=0.0, high=60e3)
    """Rounding of its ends, c. [Pa]"""

    @property
    def affine(self) -> bool:
        """Only between sharp ends."""
        return self.softness == 0

    def force(self, at: MuscleState, muscle: Muscle) -> Real:
        """Minus the pull of the pressure that the bladder holds. [N]."""
        return -self._held(at.pressure) * muscle.pull_area(at.contraction)

    def kinks(
        self, contraction: Real, diameter_ratio: Real, muscle: Muscle
    ) -> tuple[Real, ...]:
        """Both sharp ends. [Pa]."""
        still = 0.0 * contraction
        return (still - self.pressure, still + self.pressure) if self.affine else ()

    def _held(self, pressure: Real) -> Real:
        """Part of a pressure that the bladder holds, g. [Pa]."""
        if self.affine:
            above = positive_part(pressure - self.pressure)
            return positive_part(pressure + self.pressure) - above - self.pressure
        more = (pressure + self.pressure) / (2 * self.softness)
        less = (pressure - self.pressure) / (2 * self.softness)
        # What was not measured is not known here either.
        with np.errstate(invalid="ignore"):
            held: Real = np.logaddexp(more, -more) - np.logaddexp(less, -less)
        return self.softness * held
