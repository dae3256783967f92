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

from gripperd.model.effect import MuscleState
from gripperd.model.elastic_curve import ElasticCurve
from gripperd.model.muscle import Muscle
from gripperd.model.real import Real

LEAST = 0.007
"""Contraction over which no bladder saturates: a measured one of 10 mm over 0.0105, and
a magnet or a taut cable near rest length over 0.0063 at most. [-]"""


@dataclass(frozen=True, slots=True)
class NonlinearElasticity(ElasticCurve):
    """An elastic force beside eq. (5), odd in contraction and 0 at rest length."""

    name: ClassVar[str] = "nonlinear_elasticity"
    needs: ClassVar[frozenset[str]] = frozenset({"force", "pressure", "contraction"})
    shows: ClassVar[str] = (
        "a curve over contraction that is the same at all pressures, vanishes at rest"
        " length and bends otherwise than eq. (5)"
    )
    confused_with: ClassVar[tuple[str, ...]] = (
        "rubber_elasticity", "tapered_ends", "length_datum", "presliding_hysteresis",
    )  # fmt: skip
    remedy: ClassVar[str] = "add the measured elastic curve of the bladder to the model"
    basis: ClassVar[str] = "rubber_elasticity"

    @property
    def is_misnamed(self) -> bool:
        """Something else pulls near rest length alone: a cable, a magnet, a stop."""
        late = abs(self.quadratic) + abs(self.cubic)
        return self.contraction < LEAST and abs(self.saturation) > late

    def force(self, at: MuscleState, muscle: Muscle) -> Real:
        """Minus the elastic force beyond eq. (5). [N]."""
        return -self.curve(at.contraction)
