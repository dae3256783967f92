"""Force against the rate of contraction.

References
----------
.. [1] D. B. Reynolds, D. W. Repperger, C. A. Phillips, G. Bandry, "Modeling the dynamic
       characteristics of pneumatic muscle", Ann. Biomed. Eng. 31(3), 310-317, 2003:
       damping that depends on pressure.
.. [2] H. Eyring, "Viscosity, plasticity, and diffusion as examples of absolute reaction
       rates", J. Chem. Phys. 4(4), 283-291, 1936: the stress in polymers and
       lubricants goes with the inverse hyperbolic sine of the rate.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gripperd.model.effect import MuscleState
from gripperd.model.kinds import InMuscle
from gripperd.model.muscle import Muscle
from gripperd.model.parameter import amplitude, shape
from gripperd.model.real import Real, positive_part

WORKING_PRESSURE = 300e3
"""Gauge pressure at which the pressure damping has its amplitude. [Pa]"""
BRISK = 0.1
"""Rate at which the sublinear part has its amplitude. [1/s]"""


@dataclass(frozen=True, slots=True)
class ViscousFriction(InMuscle):
    r"""Damping, constant and with pressure, and a part that flows as polymers do [2]_.

    .. math:: F = -\left(a + b \frac{p}{300 kPa}\right) \dot h
              - c\,\frac{\sinh^{-1}(\dot h / v)}{\sinh^{-1}(0.1/\mathrm s / v)}
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
    turns: ClassVar[str] = "contraction"
    timed: ClassVar[bool] = True

    damping: float = amplitude(unit="N_s", scale=100.0, low=0.0, high=5000.0)
    """Force per rate of contraction, a. [N s]"""
    sublinear: float = amplitude(unit="N", scale=10.0, low=0.0, high=300.0)
    """Force at 0.1/s of the part that grows less than the rate, c. [N]"""
    pressure_damping: float = amplitude(unit="N_s", scale=100.0, low=0.0, high=5000.0)
    """Force per rate of contraction at 300 kPa, proportional to pressure, b. [N s]"""
    flow: float = shape(unit="per_s", starts=(0.02,), low=1e-3, high=0.1)
    """Rate from which that part grows less, v. [1/s]"""

    def force(self, at: MuscleState, muscle: Muscle) -> Real:
        """Against contraction while contracting, with it while extending. [N]."""
        # Under vacuum no strand is pressed: it damps less, and never pushes along.
        load = positive_part(at.pressure) / WORKING_PRESSURE
        linear = (self.damping + self.pressure_damping * load) * at.rate
        share: Real = np.arcsinh(at.rate / self.flow) / np.arcsinh(BRISK / self.flow)
        return -linear - self.sublinear * share
