"""Rubber whose modulus follows the temperature.

References
----------
.. [1] L. R. G. Treloar, "The Physics of Rubber Elasticity", 3rd ed., Oxford University
       Press, 1975, chapter 2: the modulus of ideal rubber is proportional to absolute
       temperature. Filled rubber softens instead.
.. [2] H. S. Carslaw, J. C. Jaeger, "Conduction of Heat in Solids", 2nd ed., Oxford
       University Press, 1959, section 3.4: a slab that is heated from one side.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gripperd.model.effect import ROOM, MuscleState
from gripperd.model.kinds import InMuscle
from gripperd.model.memory import begin, lag
from gripperd.model.muscle import Muscle
from gripperd.model.parameter import amplitude, shape
from gripperd.model.real import Real
from gripperd.model.track import Array, Track


@dataclass(frozen=True, slots=True)
class TemperatureStiffness(InMuscle):
    r"""The force of eq. (5) changes with temperature.

    .. math:: F = -F_s(h) \left[a (T - T_0) + b (T - T_0)^2\right]

    with ``T0 = 20 °C``. Where the temperature is not known it is taken as that. The
    rubber may follow the thermometer late: the slowest wave in a wall d thick that is
    heated from outside takes :math:`4 d^2 / \pi^2 \alpha` [2]_, 16 s in 2 mm of rubber
    (:math:`\alpha` = 1e-7 m²/s).
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

    late: float = shape(
        unit="s", starts=(0.0, 15.0), low=0.0, high=300.0, switches=True
    )
    """Time constant by which the rubber follows the thermometer; 0 for at once. [s]"""

    def rest(self) -> Array:
        """Rubber as warm as the thermometer."""
        return begin() if self.late else np.empty(0)

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Add the force of rubber that has warmed so far."""
        at = track.state
        if self.late:
            warmed = lag(track.temperature, track.step, self.late, memory)
            at = at._replace(temperature=warmed)
        return np.asarray(value + self.force(at, track.muscle))

    def force(self, at: MuscleState, muscle: Muscle) -> Real:
        """Minus the change of the elastic force. [N]."""
        warmer: Real = np.nan_to_num(at.temperature - ROOM)
        change = warmer * (self.modulus + self.modulus_square * warmer)
        return -change * muscle.elastic_force(at.contraction, at.diameter_ratio)
