"""Strands that stretch with the pressure they hold.

References
----------
.. [1] S. Davis, N. Tsagarakis, J. Canderle, D. G. Caldwell, "Enhanced modelling and
       performance in braided pneumatic muscle actuators", Int. J. Robotics Research
       22(3-4), 213-227, 2003: extension of the strands.
"""

from dataclasses import dataclass
from typing import ClassVar

from gripperd.model.effect import MuscleState
from gripperd.model.kinds import InMuscle
from gripperd.model.muscle import Muscle
from gripperd.model.parameter import amplitude
from gripperd.model.real import Real

TENTH = 0.1
"""Contraction at which the part that grows with it has its amplitude. [-]"""


@dataclass(frozen=True, slots=True)
class BraidExtensibility(InMuscle):
    r"""Strands lengthen by ``ε p`` of their length, and the muscle bulges more.

    .. math:: p \frac{3 L^2 - l^2 (1 + \varepsilon p)^2}{4 \pi n^2} - F_i
              = -p \frac{\pi D_N^2}{4 \sin^2\theta_0} \left[(1 + \varepsilon p)^2
              - 1\right]

    which is eq. (4) for strands of that length, with :math:`\varepsilon = a + b
    \frac{h}{0.1}`. By balance of the hoop a strand carries ``p L`` times a constant,
    so that linear strands have ``b = -0.1 a``.
    """

    name: ClassVar[str] = "braid_extensibility"
    needs: ClassVar[frozenset[str]] = frozenset({"force", "pressure", "contraction"})
    shows: ClassVar[str] = (
        "the force gains less and less from pressure as it rises, at every length: a"
        " deficit that grows with the square of pressure"
    )
    confused_with: ClassVar[tuple[str, ...]] = (
        "series_compliance", "pressure_sensor_gain", "force_sensor_gain",
    )  # fmt: skip
    remedy: ClassVar[str] = "use a muscle with stiffer strands, or add their stretch"

    strain: float = amplitude(unit="per_MPa", scale=0.01e-6, low=0.0, high=0.9e-6)
    """Stretch of the strands per gauge pressure at rest length, a: 0.42/MPa where soft
    strands cost 70 % of the pull at 6 bar. [1/Pa]"""
    strain_contracted: float = amplitude(
        unit="per_MPa", scale=0.002e-6, low=-0.1e-6, high=0.1e-6
    )
    """What comes on top at a contraction of 0.1, in proportion to it, b. [1/Pa]"""

    @property
    def affine(self) -> bool:
        """Only for strands that do not stretch."""
        return self.strain == self.strain_contracted == 0

    def force(self, at: MuscleState, muscle: Muscle) -> Real:
        """Minus the pull that the stretch costs. [N]."""
        strain = self.strain + self.strain_contracted * at.contraction / TENTH
        stretch = strain * at.pressure
        return -at.pressure * muscle.radial_area * stretch * (2 + stretch)
