"""What the textbook leaves out, one phenomenon a file.

To add an effect, write a file with a frozen dataclass that satisfies
:class:`gripperd.model.MuscleEffect`, and name it in :data:`EFFECTS`.
"""

from collections.abc import Mapping
from types import MappingProxyType

from gripperd.effects.braid_friction import BraidFriction
from gripperd.effects.rubber_elasticity import RubberElasticity
from gripperd.model import MuscleEffect

EFFECTS: Mapping[str, type[MuscleEffect]] = MappingProxyType(
    {effect.name: effect for effect in (RubberElasticity, BraidFriction)}
)
"""Every effect by the name that model files use."""
