"""The paper's static model in the forms that its figures compare."""

from dataclasses import dataclass
from functools import cached_property

from gripperd.effects.braid_friction import BraidFriction, Form
from gripperd.effects.rubber_elasticity import RubberElasticity
from gripperd.model import Direction, Muscle, StaticMuscle
from gripperd.model.real import Real

FIGURE_8_PRESSURE = 0.4e6
"""Pressure of Figure 8, read as gauge; the paper does not say which. [Pa]"""
ATMOSPHERE = 0.1e6
"""Ambient pressure the paper uses. [Pa]"""
HIGHEST_PRESSURE = 0.8e6
"""Gauge pressure up to which the figures are drawn here. [Pa]"""

BISECTIONS = 60
"""Halvings of the stroke; fewer than 53 would already be exact to the last bit."""


@dataclass(frozen=True)
class Paper:
    """One muscle, with and without rubber and friction."""

    muscle: Muscle

    @cached_property
    def ideal(self) -> StaticMuscle:
        """Eq. (4) alone."""
        return StaticMuscle(self.muscle)

    @cached_property
    def elastic(self) -> StaticMuscle:
        """Eqs. (4) and (5)."""
        return StaticMuscle(self.muscle, (RubberElasticity(),))

    def full(self, form: Form = Form.REBRACED) -> StaticMuscle:
        """Eqs. (4) to (6), which is eq. (7)."""
        return StaticMuscle(self.muscle, (RubberElasticity(), BraidFriction(form)))

    def rubber(self, contraction: Real) -> Real:
        """F_s of eq. (5), positive when it opposes contraction. [N]."""
        at = self.ideal.state(0.0, contraction, Direction.CONTRACTING)
        return 0.0 - RubberElasticity().force(at, self.muscle)

    def friction(
        self, pressure: Real, contraction: Real, form: Form = Form.REBRACED
    ) -> Real:
        """F_k of eq. (6). [N]."""
        at = self.ideal.state(pressure, contraction, Direction.CONTRACTING)
        return BraidFriction(form).magnitude(at, self.muscle)

    def free_contraction(
        self, static: StaticMuscle, pressure: float, direction: int = 1
    ) -> float:
        """Contraction at which the muscle no longer pulls, by bisection. [-]."""
        low, high = 0.0, self.muscle.spent
        for _ in range(BISECTIONS):
            middle = (low + high) / 2
            if static.force(pressure, middle, direction) > 0:
                low = middle
            else:
                high = middle
        return low
