"""What happened in several runs, laid end to end.

Most effects know but the moment, so that one call does for all runs; what remembers
begins anew in each.
"""

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from functools import cached_property

import numpy as np

from gripperd.model.track import Array, Geometry, Track

_COLUMNS = tuple(one.name for one in fields(Track) if one.type == Array)
"""Names of what a track has sample by sample."""


@dataclass(frozen=True, kw_only=True)
class Run(Track):
    """One of several; what all have in common is told for all at once."""

    piece: slice
    """Its samples."""
    together: Geometry
    """That of all runs."""

    @cached_property
    def diameter_ratio(self) -> Array:
        """As that of a track. [-]."""
        return self.together.diameter_ratio[self.piece]

    @cached_property
    def pull_area(self) -> Array:
        """As that of a track. [m²]."""
        return self.together.pull_area[self.piece]


@dataclass(frozen=True, kw_only=True)
class Runs(Track):
    """One run after the other."""

    slices: tuple[slice, ...]
    """Samples of each run."""
    sliding: Array
    """Direction in which the bladder slides in its braid. [-1..1]"""
    beside: Array
    """What a smooth force leaves out when a late cell speaks of it, less what it leaves
    out of the reading. [N]"""

    @cached_property
    def apart(self) -> tuple[Run, ...]:
        """Each run by itself."""
        columns = {name: getattr(self, name) for name in _COLUMNS}
        return tuple(
            Run(
                muscle=self.muscle,
                span=self.span,
                piece=piece,
                together=self.geometry,
                **{name: column[piece] for name, column in columns.items()},
            )
            for piece in self.slices
        )

    @cached_property
    def of_bladder(self) -> "Runs":
        """The same as the friction between bladder and braid has it."""
        return replace(self, direction=self.sliding)

    @cached_property
    def _ends(self) -> tuple[Array, Array]:
        """Place of the first and of the last sample of each run."""
        limits = [piece.indices(self.time.size) for piece in self.slices]
        starts, stops, _ = np.array(limits).T
        return starts, stops - 1

    def slope(self, value: Array) -> Array:
        """How fast a signal changes from sample to sample, in each run. [1/s].

        Of second order, as of :func:`numpy.gradient`; 0 in a run of one sample.
        """
        starts, ends = self._ends
        steps, changes = np.diff(self.time), np.diff(value)
        # From one run to the next nothing changes.
        steps[ends[:-1]], changes[ends[:-1]] = 1.0, 0.0
        slopes = np.concatenate([[0.0], changes / steps, [0.0]])
        steps = np.concatenate([[1.0], steps, [1.0]])
        before, after = steps[:-1], steps[1:]
        found: Array = (after * slopes[:-1] + before * slopes[1:]) / (before + after)
        found[starts], found[ends] = slopes[starts + 1], slopes[ends]
        return found

    def each(self, change: Callable[[Array, Track], Array], value: Array) -> Array:
        """Change a signal in each run by itself."""
        return np.concatenate(
            [
                change(value[piece], run)
                for piece, run in zip(self.slices, self.apart, strict=True)
            ]
        )
