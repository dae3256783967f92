"""Tapered ends: the middle of the muscle contracts more than the whole.

References
----------
.. [1] B. Tondu, P. Lopez, "Modeling and control of McKibben artificial muscle robot
       actuators", IEEE Control Syst. Mag. 20(2), 15-38, 2000: factor k on contraction.
.. [2] B.-S. Kang, C. S. Kothera, B. K. S. Woods, N. M. Wereley, "Dynamic modeling of
       Mckibben pneumatic artificial muscles for antagonistic actuation", IEEE Int.
       Conf. Robotics and Automation, 182-187, 2009: k falls with pressure.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gripperd.model.effect import MuscleState
from gripperd.model.kinds import InMuscle
from gripperd.model.muscle import Muscle
from gripperd.model.parameter import amplitude
from gripperd.model.real import Real

FILLING = 200e3
"""Pressure over which the part that belongs to a vented muscle fades. [Pa]"""
TENTH = 0.1
"""Contraction at which the part that grows with it has its amplitude. [-]"""


@dataclass(frozen=True, slots=True)
class TaperedEnds(InMuscle):
    r"""The pull is that of the middle, which is shorter than the whole says.

    .. math:: F = p \left[A(k h) - A(h)\right], \quad
              k = 1 + a + b e^{-p/200 kPa} + c \frac{h}{0.1}

    With arcs for ends, k falls with contraction: c is below 0.
    """

    name: ClassVar[str] = "tapered_ends"
    needs: ClassVar[frozenset[str]] = frozenset({"force", "pressure", "contraction"})
    shows: ClassVar[str] = (
        "a deficit proportional to pressure that grows with contraction and vanishes"
        " at rest length"
    )
    confused_with: ClassVar[tuple[str, ...]] = (
        "nonlinear_elasticity", "length_datum", "presliding_hysteresis",
    )  # fmt: skip
    remedy: ClassVar[str] = "give the model the contraction of the middle, factor k"

    excess: float = amplitude(unit=None, scale=0.1, low=-0.3, high=1.0)
    """Contraction of the middle beyond that of the whole, a. [-]"""
    excess_vented: float = amplitude(unit=None, scale=0.1, low=-0.3, high=1.0)
    """What comes on top in a vented muscle, b. [-]

    That of [2]_ has 3. Given so much room, it would be told for the rubber that the
    map of a DMSP-20 needs.
    """
    excess_contracted: float = amplitude(unit=None, scale=0.05, low=-0.3, high=0.3)
    """What comes on top at a contraction of 0.1, in proportion to it, c. [-]"""

    @property
    def affine(self) -> bool:
        """Only when the factor does not depend on pressure."""
        return self.excess_vented == 0

    def force(self, at: MuscleState, muscle: Muscle) -> Real:
        """Pull at the contraction of the middle minus that at the whole. [N]."""
        excess = self.excess + self.excess_contracted * at.contraction / TENTH
        if not self.affine:
            excess = excess + self.excess_vented * np.exp(-at.pressure / FILLING)
        middle = at.contraction * (1 + excess)
        gain = muscle.pull_area(middle) - muscle.pull_area(at.contraction)
        return at.pressure * gain
