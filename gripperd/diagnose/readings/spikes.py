"""One to three samples far away from both neighbours, with nothing to explain them."""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray
from scipy.ndimage import binary_dilation

from gripperd.diagnose.readings.fault import Fault, Mask
from gripperd.diagnose.readings.recording import Run
from gripperd.model.track import Array

WIDEST = 3
"""Samples."""
STRICT, LOOSE = 8.0, 4.0
"""How many times larger than the usual steps a spike is, and a movement that could
explain it."""
RETURN = 0.25
"""Share of its height by which the signal before and after may differ; a step, which
does not return, is thereby never a spike."""
SHARE = 0.02
"""Part of the range of the channel over the recording that a spike has at least."""
AROUND = 8
"""Samples on each side that say which steps are usual."""
OVER_STEP = 0.8
"""Height in the largest step around; what rings after a true step is lower."""
AMONG = 3.0
"""The same from which it is one however often the signal steps, as up a staircase."""
COMMON = 0.05
"""A larger share of samples is not isolated; it is the signal."""
CAUSES = frozenset(
    {"current", "pressure", "contraction", "length", "opening", "force", "grip"}
)
"""Columns whose movement can explain that of another."""
KEPT = frozenset({"time", "current", "object", "supply"})
"""What is set, not measured; and the supply, which does sag for a moment."""


def spikes(runs: Sequence[Run]) -> Iterator[Fault]:
    """Find isolated spikes, column by column.

    A spike that another column shares may be a movement, and stays.

    References
    ----------
    .. [1] R. K. Pearson, "Outliers in process modeling and identification", IEEE Trans.
           Control Syst. Technol. 10(1), 55-63, 2002: comparing with the neighbourhood.
    """
    least = {
        quantity: SHARE * _range(runs, quantity)
        for quantity in {key for run in runs for key in run.columns}
    }
    for index, run in enumerate(runs):
        moved = {
            quantity: departures(values, least[quantity], LOOSE)
            for quantity, values in run.columns.items()
            if quantity != "time"
        }
        for quantity, loose in moved.items():
            if quantity in KEPT or not loose.any():
                continue
            rows = departures(run.columns[quantity], least[quantity], STRICT)
            for other in moved.keys() & CAUSES - {quantity}:
                rows &= ~moved[other]
            if rows.sum() <= max(WIDEST, COMMON * len(run)):
                yield Fault(index, quantity, rows, "spike")


def departures(values: Array, least: float, times: float) -> Mask:
    """Mark where a signal leaves its neighbourhood for a few samples and returns.

    Parameters
    ----------
    values
        Column of a run, shape ``(n,)``.
    least
        Height that a departure has at least. [unit of the column]
    times
        Height that it has at least, in steps that are usual in the run and around it.
    """
    mask = _departed(values, least, times)
    if not mask.any():
        return mask
    # A higher one no longer hides the next, but what it stood beside is no other.
    while True:
        left = np.where(mask, np.nan, values)
        beside = binary_dilation(mask, iterations=WIDEST)
        more = _departed(left, least, times) & ~beside
        if not more.any():
            return mask
        mask |= more


def _departed(values: Array, least: float, times: float) -> Mask:
    mask = np.zeros(values.size, dtype=np.bool_)
    measured = np.flatnonzero(np.isfinite(values))
    signal = values[measured]
    if signal.size <= AROUND:
        return mask
    steps = np.abs(np.diff(signal))
    # Most samples fall at this hurdle, which is cheaper than a look around each.
    height = max(least, times * float(np.median(steps)))
    for width in range(1, WIDEST + 1):
        for start in _returning(signal, width, height, steps, times):
            mask[measured[start : start + width]] = True
    return mask


def _returning(
    signal: Array, width: int, height: float, steps: Array, times: float
) -> NDArray[np.intp]:
    """First samples of departures of one width."""
    inside = sliding_window_view(signal[1:-1], width)
    before, after = signal[: -width - 1], signal[width + 1 :]
    top, bottom = np.maximum(before, after), np.minimum(before, after)
    over = np.maximum(inside.min(axis=1) - top, bottom - inside.max(axis=1))
    starts = np.flatnonzero((over > height) & (top - bottom <= RETURN * over))
    # Steps on both sides, without the two that lead into the departure and out of it.
    padded = np.pad(steps, AROUND, constant_values=np.nan)
    left = starts[:, np.newaxis] + np.arange(AROUND)
    right = left + AROUND + width + 1
    around = np.hstack([padded[left], padded[right]])
    usual = times * np.nanpercentile(around, 75, axis=1)
    largest = np.nanmax(around, axis=1)
    least = np.clip(usual, OVER_STEP * largest, AMONG * largest)
    isolated: NDArray[np.intp] = starts[over[starts] > least] + 1
    return isolated


def _range(runs: Sequence[Run], quantity: str) -> float:
    columns = [run.columns[quantity] for run in runs if run.has(quantity)]
    if not columns:
        return 0.0
    low, high = np.nanpercentile(np.concatenate(columns), (1, 99))
    return float(high - low)
