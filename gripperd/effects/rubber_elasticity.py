"""Elastic force of the bladder, eq. (5).

References
----------
.. [1] "Study on static characteristics of pneumatic muscles", eq. (5).
"""

from dataclasses import dataclass
from typing import ClassVar

from gripperd.model import Muscle, MuscleState
from gripperd.model.kinds import InMuscle
from gripperd.model.real import Real


@dataclass(frozen=True, slots=True)
class RubberElasticity(InMuscle):
    """The stretched rubber pulls back towards rest.

    Shows in data as a force that depends on contraction alone, the same at all
    pressures, and vanishes at rest length.
    """

    name: ClassVar[str] = "rubber_elasticity"
    needs: ClassVar[frozenset[str]] = frozenset({"force", "pressure", "contraction"})
    shows: ClassVar[str] = (
        "the force is too high by an amount that depends on contraction alone, the"
        " same at all pressures, and vanishes at rest length"
    )
    confused_with: ClassVar[tuple[str, ...]] = ("nonlinear_elasticity",)
    remedy: ClassVar[str] = "add the bladder's modulus and wall to the model"

    def force(self, at: MuscleState, muscle: Muscle) -> Real:
        """Minus the elastic force of eq. (5), see :meth:`Muscle.elastic_force`. [N]."""
        return -muscle.elastic_force(at.contraction, at.diameter_ratio)
