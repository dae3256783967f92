"""Dry friction that grows with a power of pressure, beyond eq. (6).

References
----------
.. [1] B. Tondu, "Modelling of the McKibben artificial muscle: a review", J. Intell.
       Mater. Syst. Struct. 23(3), 225-253, 2012: textile friction grows less than
       proportionally with the load.
"""

from dataclasses import dataclass
from typing import ClassVar

from gripperd.model.effect import MuscleState
from gripperd.model.kinds import InMuscle
from gripperd.model.muscle import Muscle
from gripperd.model.parameter import amplitude, shape
from gripperd.model.real import Real, positive_part
from gripperd.model.slip import called_up

WORKING_PRESSURE = 300e3
"""Gauge pressure at which the friction has its amplitude. [Pa]"""


@dataclass(frozen=True, slots=True)
class PressureFriction(InMuscle):
    r"""A force against the direction of travel, with strands that press harder.

    .. math:: F = \mp a \left(\frac{p}{300 kPa}\right)^b, \quad p \ge 0

    times :func:`gripperd.model.slip.called_up`, where what creeps rubs less.
    """

    name: ClassVar[str] = "pressure_friction"
    needs: ClassVar[frozenset[str]] = frozenset({"force", "pressure", "contraction"})
    shows: ClassVar[str] = (
        "a loop over contraction that is wider at higher pressure and closes in a"
        " vented muscle"
    )
    confused_with: ClassVar[tuple[str, ...]] = (
        "coulomb_friction", "braid_friction", "presliding_hysteresis",
    )  # fmt: skip
    remedy: ClassVar[str] = "always approach a grip from the same side"
    turns: ClassVar[str] = "contraction"
    basis: ClassVar[str] = "braid_friction"

    magnitude: float = amplitude(unit="N", scale=20.0, low=0.0, high=300.0)
    """Friction at 300 kPa, a. [N]"""
    exponent: float = shape(unit=None, starts=(1.0, 0.5, 0.75, 1.5), low=0.3, high=2.0)
    """Power of pressure, b. [-]"""
    slip: float = shape(
        unit="per_s", starts=(0.0, 3e-3), low=0.0, high=1e-2, switches=True
    )
    """Rate of contraction at which three quarters of it are there; 0 for any. [1/s]"""

    @property
    def affine(self) -> bool:
        """Only when it is proportional to pressure."""
        return self.exponent == 1

    def force(self, at: MuscleState, muscle: Muscle) -> Real:
        """Against contraction while contracting, with it while extending. [N]."""
        load = positive_part(at.pressure) / WORKING_PRESSURE
        size = self.magnitude * load**self.exponent
        return -at.direction * size * called_up(at.rate, self.slip)

    def kinks(
        self, contraction: Real, diameter_ratio: Real, muscle: Muscle
    ) -> tuple[Real, ...]:
        """Where the muscle is vented. [Pa]."""
        return (0.0 * contraction,)
