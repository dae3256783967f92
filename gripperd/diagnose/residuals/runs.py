"""What happened in several runs, laid end to end.

Most effects know but the moment, so that one call does for all runs; what remembers
begins anew in each.
"""

from collections.abc import Callable
from dataclasses import dataclass, fields
from functools import cached_property

import numpy as np

from gripperd.model.track import Array, Track


@dataclass(frozen=True, kw_only=True)
class Runs(Track):
    """One run after the other."""

    slices: tuple[slice, ...]
    """Samples of each run."""

    @cached_property
    def apart(self) -> tuple[Track, ...]:
        """Each run by itself."""
        columns = {
            field.name: value
            for field in fields(Track)
            if isinstance(value := getattr(self, field.name), np.ndarray)
        }
        return tuple(
            Track(
                muscle=self.muscle,
                span=self.span,
                **{name: column[piece] for name, column in columns.items()},
            )
            for piece in self.slices
        )

    def each(self, change: Callable[[Array, Track], Array], value: Array) -> Array:
        """Change a signal in each run by itself."""
        return np.concatenate(
            [
                change(value[piece], run)
                for piece, run in zip(self.slices, self.apart, strict=True)
            ]
        )
