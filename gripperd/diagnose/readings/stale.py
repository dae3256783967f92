"""Stale readings: told again row by row, until the next one is there.

A logger that is faster than one of its channels repeats what it has. As so many
readings of their own they would have hardly any noise, and come late.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from gripperd.diagnose.readings.columns import BY_QUANTITY
from gripperd.diagnose.readings.frozen import COMMANDED
from gripperd.diagnose.readings.recording import Recording
from gripperd.diagnose.readings.stretches import resolution
from gripperd.model.track import Array

LONGEST = 10
"""Rows for which one reading is told at most; longer, a channel stands or is slow."""
REGULAR = 0.8
"""Share of the rows in which readings are told as often as usual, give or take one."""
COARSE = 3.0
"""Resolutions between readings from which equal ones are no coincidence. [-]"""


def without_stale(recording: Recording) -> Recording:
    """Keep of readings that are told again the first, as missing are the others."""
    remarks = []
    runs = [dict(run.columns) for run in recording.runs]
    names = {name for columns in runs for name in columns} - COMMANDED
    for name in sorted(names):
        told = [columns[name] for columns in runs if name in columns]
        usual = _times_told(told)
        if usual < 2:
            continue
        for columns in runs:
            if name in columns:
                columns[name] = _first_told(columns[name], 2 * usual + 1)
        column = BY_QUANTITY[name].name
        remarks.append(f"{column} tells each reading {usual} times: the first counts.")
    if not remarks:
        return recording
    return replace(
        recording,
        runs=tuple(
            replace(run, columns=columns)
            for run, columns in zip(recording.runs, runs, strict=True)
        ),
        remarks=(*recording.remarks, *remarks),
    )


def _times_told(columns: Sequence[Array]) -> int:
    """How many rows tell each reading of a column; 1 if they are all its own."""
    lengths = np.concatenate([
        _lengths(column)[np.isfinite(column[_starts(column)])] for column in columns
    ])  # fmt: skip
    rows = np.repeat(lengths, lengths)
    usual = int(np.median(rows)) if rows.size else 1
    if not 2 <= usual <= LONGEST or np.mean(np.abs(rows - usual) <= 1) < REGULAR:
        return 1
    every = np.concatenate(columns)
    steps = np.abs(np.diff(every))
    moved = steps[steps > 0]
    is_fine = moved.size and np.median(moved) >= COARSE * resolution(every)
    return usual if is_fine else 1


def _lengths(column: Array) -> NDArray[np.int64]:
    """Rows for which each value of a column stands, shape ``(n,)``."""
    starts = _starts(column)
    return np.diff([*starts.tolist(), column.size]).astype(np.int64)


def _starts(column: Array) -> NDArray[np.int64]:
    return np.flatnonzero(np.diff(column, prepend=np.inf) != 0)


def _first_told(column: Array, most: int) -> Array:
    out = column.copy()
    starts = _starts(column)
    for start, length in zip(starts.tolist(), _lengths(column).tolist(), strict=True):
        if length <= most:
            out[start + 1 : start + length] = np.nan
    return out
