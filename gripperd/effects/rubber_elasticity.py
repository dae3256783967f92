"""Elastic force of the bladder, eq. (5).

References
----------
.. [1] "Study on static characteristics of pneumatic muscles", eq. (5).
"""

from dataclasses import dataclass
from typing import ClassVar

from gripperd.model import Muscle, MuscleState
from gripperd.model.elastic_curve import ElasticCurve
from gripperd.model.parameter import amplitude
from gripperd.model.real import Real


@dataclass(frozen=True, slots=True)
class RubberElasticity(ElasticCurve):
    r"""The stretched rubber pulls back towards rest.

    .. math:: F = -k F_s(h) - G(h)

    with F_s of eq. (5) and a curve G of :class:`ElasticCurve`, which is 0 unless it
    was measured: a bladder follows eq. (5) no further than thin linear rubber does.

    Shows in data as a force that depends on contraction alone, the same at all
    pressures, and vanishes at rest length.
    """

    name: ClassVar[str] = "rubber_elasticity"
    needs: ClassVar[frozenset[str]] = frozenset({"force", "pressure", "contraction"})
    shows: ClassVar[str] = (
        "the muscle pulls less than the model says, by an amount that depends on"
        " contraction alone, the same at all pressures, and vanishes at rest length"
    )
    confused_with: ClassVar[tuple[str, ...]] = ("nonlinear_elasticity",)
    remedy: ClassVar[str] = "add the bladder's modulus and wall to the model"

    share: float = amplitude(unit=None, scale=1.0, low=0.0, high=4.0, default=1.0)
    """Of the force of eq. (5), k. [-]"""

    def force(self, at: MuscleState, muscle: Muscle) -> Real:
        """Minus the elastic force, see :meth:`Muscle.elastic_force`. [N]."""
        pull = muscle.elastic_force(at.contraction, at.diameter_ratio)
        if self.share != 1.0:
            pull = self.share * pull
        if self.saturation or self.quadratic or self.cubic:
            pull = pull + self.curve(at.contraction)
        return -pull
