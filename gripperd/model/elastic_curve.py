"""A force over contraction in no particular form: it saturates, bends and stiffens."""

from dataclasses import dataclass

import numpy as np

from gripperd.model.kinds import InMuscle
from gripperd.model.parameter import amplitude, shape
from gripperd.model.real import Real

TENTH = 0.1
"""Contraction at which the powers have their amplitude. [-]"""


@dataclass(frozen=True, slots=True)
class ElasticCurve(InMuscle):
    r"""An elastic force, odd in contraction and 0 at rest length.

    .. math:: F(h) = \operatorname{sgn} h \left[a (1 - e^{-|h|/h_c})
              + b \left(\frac{h}{0.1}\right)^2
              + c \left|\frac{h}{0.1}\right|^3 \right]
    """

    saturation: float = amplitude(unit="N", scale=50.0, low=-600.0, high=600.0)
    """Force that is reached early and then stays, a. [N]"""
    quadratic: float = amplitude(unit="N", scale=20.0, low=-300.0, high=300.0)
    """Force at a contraction of 0.1 that grows with its square, b. [N]"""
    cubic: float = amplitude(unit="N", scale=10.0, low=-200.0, high=200.0)
    """Force at a contraction of 0.1 that grows with its cube, c. [N]"""
    contraction: float = shape(unit=None, starts=(0.03, 0.01, 0.1), low=0.003, high=0.3)
    """Contraction over which the first saturates, h_c. [-]"""

    def curve(self, contraction: Real) -> Real:
        """Force at a contraction. [N]."""
        away: Real = np.abs(contraction)
        tenths = away / TENTH
        early: Real = -np.expm1(-away / self.contraction)
        late = tenths * tenths * (self.quadratic + self.cubic * tenths)
        side: Real = np.sign(contraction)
        return side * (self.saturation * early + late)
