"""Where the search stands: constants moved, effects added."""

from dataclasses import dataclass, replace

import numpy as np

from gripperd.model.effect import Effect
from gripperd.model.track import Array

FREED = 12.0
"""Prior of a wrong constant, in its stated sigma."""


@dataclass(frozen=True, slots=True)
class Point:
    """Where the search stands: constants, and effects added to the model."""

    shifts: Array
    """Of the constants from nominal, in sigma."""
    effects: tuple[Effect, ...] = ()
    freed: frozenset[int] = frozenset()
    """Constants found to be wrong: their tolerance no longer holds them."""
    looser: tuple[float, ...] = ()
    """Prior of each constant instead, in its stated sigma; none for as stated."""
    stiction: float = 0.0
    """By how much better friction holds what rests than what slides. [-]"""

    @property
    def widths(self) -> Array:
        """Prior of each constant, in its stated sigma."""
        if self.looser:
            return np.array(self.looser)
        widths = np.ones_like(self.shifts)
        widths[list(self.freed)] = FREED
        return widths

    def with_effect(self, effect: Effect) -> "Point":
        """Put an effect in, in the place of one of its name if there is."""
        others = tuple(one for one in self.effects if one.name != effect.name)
        return replace(self, effects=(*others, effect))

    def without(self, name: str) -> "Point":
        """Take an effect out."""
        return replace(
            self, effects=tuple(one for one in self.effects if one.name != name)
        )
