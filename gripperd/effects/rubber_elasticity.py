"""Elastic force of the bladder, eq. (5).

References
----------
.. [1] "Study on static characteristics of pneumatic muscles", eq. (5).
.. [2] A. Martens, I. Boblan, "Modeling the static force of a Festo pneumatic muscle
       actuator", Actuators 6(4), 33, 2017: the same two terms, with E = E(L).
"""

from dataclasses import dataclass
from typing import ClassVar

from gripperd.model import Muscle, MuscleState
from gripperd.model.real import Real


@dataclass(frozen=True, slots=True)
class RubberElasticity:
    """The stretched rubber pulls back towards rest.

    Shows in data as a force that depends on contraction alone, the same at all
    pressures, and vanishes at rest length.
    """

    name: ClassVar[str] = "rubber_elasticity"

    def force(self, at: MuscleState, muscle: Muscle) -> Real:
        r"""Minus the elastic force of eq. (5).

        .. math:: F_s = E t \pi D_0 \left\{ \frac{(1-h)^2}{\tan^2\theta_0}
                  \left(1 - \frac{1}{s}\right) + h s \right\}

        The first term is the hoop, carried to the axis by the braid; the second is
        the axial stress. Thin wall of constant thickness, linear rubber.

        Returns
        -------
        Force on the axis: negative when shortened, positive when stretched. [N]
        """
        length = 1 - at.contraction
        hoop = muscle.cot_squared * (length * length) * (1 - 1 / at.diameter_ratio)
        axial = at.contraction * at.diameter_ratio
        return -muscle.rubber_stiffness * (hoop + axial)

    def kinks(
        self, contraction: Real, diameter_ratio: Real, muscle: Muscle
    ) -> tuple[Real, ...]:
        """None: the force does not depend on pressure."""
        return ()
