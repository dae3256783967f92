"""Force against the rate of contraction.

References
----------
.. [1] D. B. Reynolds, D. W. Repperger, C. A. Phillips, G. Bandry, "Modeling the dynamic
       characteristics of pneumatic muscle", Ann. Biomed. Eng. 31(3), 310-317, 2003:
       damping that depends on pressure.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gripperd.model.effect import MuscleState
from gripperd.model.kinds import InMuscle
from gripperd.model.muscle import Muscle
from gripperd.model.parameter import amplitude
from gripperd.model.real import Real

WORKING_PRESSURE = 300e3
"""Gauge pressure at which the pressure damping has its amplitude. [Pa]"""
BRISK = 0.1
"""Rate at which the sublinear part has its amplitude. [1/s]"""


@dataclass(frozen=True, slots=True)
class ViscousFriction(InMuscle):
    r"""Damping, constant and with pressure, and a part that saturates.

    .. math:: F = -\left(a + b \frac{p}{300 kPa}\right) \dot h
              - c \operatorname{sgn}\dot h \sqrt{\frac{|\dot h|}{0.1/s}}
    """

    name: ClassVar[str] = "viscous_friction"
    needs: ClassVar[frozenset[str]] = frozenset({"force", "pressure", "contraction"})
    shows: ClassVar[str] = (
        "a loop over contraction that is wider the faster it is run, and no force when"
        " still"
    )
    confused_with: ClassVar[tuple[str, ...]] = (
        "coulomb_friction", "channel_delay", "presliding_hysteresis",
    )  # fmt: skip
    remedy: ClassVar[str] = "move more slowly where the force matters"
    travels: ClassVar[bool] = True
    timed: ClassVar[bool] = True

    damping: float = amplitude(unit="N_s", scale=100.0, low=0.0, high=5000.0)
    """Force per rate of contraction, a. [N s]"""
    sublinear: float = amplitude(unit="N", scale=10.0, low=0.0, high=300.0)
    """Force at 0.1/s that grows with the root of the rate, c. [N]"""
    pressure_damping: float = amplitude(unit="N_s", scale=100.0, low=0.0, high=5000.0)
    """Force per rate of contraction at 300 kPa, proportional to pressure, b. [N s]"""

    def force(self, at: MuscleState, muscle: Muscle) -> Real:
        """Against contraction while contracting, with it while extending. [N]."""
        load = at.pressure / WORKING_PRESSURE
        linear = (self.damping + self.pressure_damping * load) * at.rate
        speed: Real = np.abs(at.rate)
        side: Real = np.sign(at.rate)
        return -linear - self.sublinear * side * (speed / BRISK) ** 0.5
