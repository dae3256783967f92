"""Where the search stands: constants moved, effects added."""

from dataclasses import dataclass, replace

import numpy as np

from gripperd.model.effect import Effect
from gripperd.model.track import Array

FREED = 12.0
"""Width within which a wrong constant is looked for, in its stated sigma."""


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

    @property
    def surprise(self) -> float:
        """How much less likely wrong constants are this far off than looked for. [nat].

        A part that is wrong is off by a few of its tolerances rather than by many: as a
        normal distribution whose sigma is known to a factor of two or so, which is
        Student's with two degrees of freedom. 14 tolerances are 36 times less likely
        than 4. Up to 2.8, a constant is as likely as it was looked for, and no more.
        """
        shifts = self.shifts[list(self.freed)]
        student = -1.5 * np.log1p(shifts**2 / 2) - 1.5 * np.log(2)
        normal = -0.5 * (shifts / FREED) ** 2 - 0.5 * np.log(2 * np.pi) - np.log(FREED)
        return 0.0 if self.looser else float(np.sum(np.maximum(normal - student, 0.0)))

    def with_effect(self, effect: Effect) -> "Point":
        """Put an effect in, last, and take out one of its name."""
        others = self.without(effect.name).effects
        return replace(self, effects=(*others, effect))

    def changed(self, effect: Effect) -> "Point":
        """Change one that acts: it acts in its turn as before, on what it acted on."""
        same = (effect if one.name == effect.name else one for one in self.effects)
        return replace(self, effects=tuple(same))

    def without(self, name: str) -> "Point":
        """Take an effect out."""
        return replace(
            self, effects=tuple(one for one in self.effects if one.name != name)
        )
