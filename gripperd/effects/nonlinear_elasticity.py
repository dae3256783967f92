"""Rubber that stiffens or saturates: its force departs from eq. (5).

References
----------
.. [1] G. K. Klute, B. Hannaford, "Accounting for elastic energy storage in McKibben
       artificial muscle actuators", J. Dyn. Sys., Meas., Control 122(2), 386-388,
       2000: Mooney-Rivlin bladder.
.. [2] A. Martens, I. Boblan, "Modeling the static force of a Festo pneumatic muscle
       actuator", Actuators 6(4), 33, 2017: modulus that depends on length.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gripperd.model.effect import MuscleState
from gripperd.model.kinds import InMuscle
from gripperd.model.muscle import Muscle
from gripperd.model.parameter import amplitude, shape
from gripperd.model.real import Real

TENTH = 0.1
"""Contraction at which the powers have their amplitude. [-]"""


@dataclass(frozen=True, slots=True)
class NonlinearElasticity(InMuscle):
    r"""An elastic force beside eq. (5), odd in contraction and 0 at rest length.

    .. math:: F = -\operatorname{sgn} h \left[a (1 - e^{-|h|/h_c})
              + b \left(\frac{h}{0.1}\right)^2
              + c \left|\frac{h}{0.1}\right|^3 \right]
    """

    name: ClassVar[str] = "nonlinear_elasticity"
    needs: ClassVar[frozenset[str]] = frozenset({"force", "pressure", "contraction"})
    shows: ClassVar[str] = (
        "a curve over contraction that is the same at all pressures, vanishes at rest"
        " length and bends otherwise than eq. (5)"
    )
    confused_with: ClassVar[tuple[str, ...]] = (
        "rubber_elasticity", "tapered_ends", "length_datum",
    )  # fmt: skip
    remedy: ClassVar[str] = "add the measured elastic curve of the bladder to the model"

    saturation: float = amplitude(unit="N", scale=50.0, low=-600.0, high=600.0)
    """Force that is reached early and then stays, a. [N]"""
    quadratic: float = amplitude(unit="N", scale=20.0, low=-300.0, high=300.0)
    """Force at a contraction of 0.1 that grows with its square, b. [N]"""
    cubic: float = amplitude(unit="N", scale=10.0, low=-200.0, high=200.0)
    """Force at a contraction of 0.1 that grows with its cube, c. [N]"""
    contraction: float = shape(unit=None, starts=(0.03, 0.01, 0.1), low=0.003, high=0.3)
    """Contraction over which the first saturates, h_c. [-]"""

    def force(self, at: MuscleState, muscle: Muscle) -> Real:
        """Minus the elastic force beyond eq. (5). [N]."""
        away: Real = np.abs(at.contraction)
        tenths = away / TENTH
        early: Real = -np.expm1(-away / self.contraction)
        late = tenths * tenths * (self.quadratic + self.cubic * tenths)
        side: Real = np.sign(at.contraction)
        return -side * (self.saturation * early + late)
