"""Rubber whose modulus follows the temperature.

References
----------
.. [1] L. R. G. Treloar, "The Physics of Rubber Elasticity", 3rd ed., Oxford University
       Press, 1975, chapter 2: the modulus of ideal rubber is proportional to absolute
       temperature. Filled rubber softens instead.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gripperd.model.effect import ROOM, MuscleState
from gripperd.model.kinds import InMuscle
from gripperd.model.muscle import Muscle
from gripperd.model.parameter import amplitude
from gripperd.model.real import Real


@dataclass(frozen=True, slots=True)
class TemperatureStiffness(InMuscle):
    r"""The force of eq. (5) changes with temperature.

    .. math:: F = -F_s(h) \left[a (T - T_0) + b (T - T_0)^2\right]

    with ``T0 = 20 °C``. Where the temperature is not known it is taken as that.
    """

    name: ClassVar[str] = "temperature_stiffness"
    needs: ClassVar[frozenset[str]] = frozenset(
        {"force", "pressure", "contraction", "temperature"}
    )
    shows: ClassVar[str] = (
        "cold and warm runs differ by a force that grows with contraction and vanishes"
        " at rest length"
    )
    confused_with: ClassVar[tuple[str, ...]] = ("force_sensor_drift", "fatigue")
    remedy: ClassVar[str] = (
        "let the muscle reach its working temperature, or measure it and correct"
    )

    modulus: float = amplitude(unit="per_K", scale=0.005, low=-0.05, high=0.05)
    """Relative change of the modulus that eq. (5) has, a. [1/K]"""
    modulus_square: float = amplitude(unit="per_K2", scale=2e-4, low=-5e-3, high=5e-3)
    """Its change with the square of the difference, b. [1/K²]"""

    def force(self, at: MuscleState, muscle: Muscle) -> Real:
        """Minus the change of the elastic force. [N]."""
        warmer: Real = np.nan_to_num(at.temperature - ROOM)
        change = warmer * (self.modulus + self.modulus_square * warmer)
        return -change * muscle.elastic_force(at.contraction, at.diameter_ratio)
