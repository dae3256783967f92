"""Stretches of one column in which the reading repeats exactly."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gripperd.diagnose.readings.fault import Mask
from gripperd.diagnose.readings.recording import Run
from gripperd.model.track import Array

BLOCK = 5
"""Samples whose median stands for them when movement is told from noise."""
BEYOND = 10.0
"""Standard deviations of noise that are movement."""
HELD = {"contraction": 0.002, "length": 0.5e-3}
"""Range within which a muscle is held. [-], [m]"""
MEDIAN = 0.6745
"""Median of the size of normal noise, in standard deviations."""


@dataclass(frozen=True, slots=True)
class Stretch:
    """Neighbouring readings of one value."""

    value: float
    rows: NDArray[np.intp]
    """Positions in the run, rising."""

    def mask(self, size: int) -> Mask:
        """Mark its rows among `size`."""
        mask = np.zeros(size, dtype=np.bool_)
        mask[self.rows] = True
        return mask

    def travel(self, run: Run, quantity: str) -> float:
        """How far another column moved meanwhile, 0 when only its noise did.

        Medians of a few samples are compared, and have to differ by far more than
        neighbours do without a trend. Too few samples say nothing: 0.
        """
        values = run.columns.get(quantity, np.empty(0))
        inside = values[self.rows] if values.size else values
        inside = inside[np.isfinite(inside)]
        if inside.size < 2 * BLOCK:
            return 0.0
        blocks = inside[: inside.size // BLOCK * BLOCK].reshape(-1, BLOCK)
        moved = float(np.ptp(np.median(blocks, axis=1)))
        return moved if moved > BEYOND * roughness(inside) else 0.0

    def held(self, run: Run) -> bool:
        """Whether the muscle was measured to keep its length meanwhile."""
        for quantity, tolerance in HELD.items():
            if run.has(quantity):
                inside = run.columns[quantity][self.rows]
                inside = inside[np.isfinite(inside)]
                return bool(inside.size and np.ptp(inside) <= tolerance)
        return False


def stretches(values: Array, shortest: int) -> Iterator[Stretch]:
    """Give the stretches of at least so many readings; gaps do not end a stretch."""
    measured = np.flatnonzero(np.isfinite(values))
    seen = values[measured]
    starts = np.r_[0, np.flatnonzero(np.diff(seen)) + 1]
    lengths = np.diff(np.r_[starts, seen.size])
    long = lengths >= shortest
    for start, length in zip(starts[long], lengths[long], strict=True):
        yield Stretch(float(seen[start]), measured[start : start + length])


def resolution(values: Array) -> float:
    """Smallest difference of two readings that differ; 0 when none do."""
    steps = np.diff(np.unique(values[np.isfinite(values)]))
    return float(steps.min(initial=np.inf)) if steps.size else 0.0


def roughness(values: Array, order: int = 2) -> float:
    """Standard deviation of white noise with as large differences of an order.

    The higher the order, the less is left of a signal that is smooth: differences of
    white noise have the variance ``comb(2k, k)``.
    """
    median = float(np.median(np.abs(np.diff(values, order))))
    return median / MEDIAN / math.sqrt(math.comb(2 * order, order))
