"""Stale readings: told again row by row, until the next one is there.

A logger that is faster than one of its channels repeats what it has. As so many
readings of their own they would have hardly any noise, and come late. A row in which
all is told again, because the logger asked faster than the rig measures, is no row.
"""

from collections.abc import Sequence, Set
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from gripperd.diagnose.readings.columns import BY_QUANTITY
from gripperd.diagnose.readings.fault import Mask
from gripperd.diagnose.readings.frozen import COMMANDED
from gripperd.diagnose.readings.recording import Recording, Run
from gripperd.diagnose.readings.stretches import resolution
from gripperd.model.track import Array

LONGEST = 10
"""Rows for which one reading is told at most; longer, a channel stands or is slow."""
REGULAR = 0.8
"""Share of the rows in which readings are told as often as usual, give or take one."""
FRESH = 0.02
"""Share of rows told again in which something may be new: cells get lost. [-]"""
COARSE = 3.0
"""Resolutions between readings from which equal ones are no coincidence. [-]"""


def without_stale(recording: Recording) -> Recording:
    """Keep of readings that are told again the first, as missing are the others.

    Rows without any reading of their own are left out.
    """
    remarks, stale = [], set()
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
        stale.add(name)
        column = BY_QUANTITY[name].name
        remarks.append(f"{column} tells each reading {usual} times: the first counts.")
    if not remarks:
        return recording
    return replace(
        recording,
        runs=_of_own_rows(recording.runs, runs, stale),
        remarks=(*recording.remarks, *remarks),
    )


def _of_own_rows(
    runs: Sequence[Run], counted: Sequence[dict[str, Array]], stale: Set[str]
) -> tuple[Run, ...]:
    """Give runs columns whose readings count once, and leave out rows told again."""
    found = [_told_and_fresh(*one, stale) for one in zip(runs, counted, strict=True)]
    told, fresh = (np.concatenate(rows) for rows in zip(*found, strict=True))
    # A coarse reading is often like the last one, and yet is one where others move.
    again = fresh[told].sum() <= FRESH * told.sum()
    out = []
    for run, columns, (gone, new) in zip(runs, counted, found, strict=True):
        kept = new | ~gone | (not again)
        own = {name: column[kept] for name, column in columns.items()}
        out.append(replace(run, columns=own))
    return tuple(out)


def _told_and_fresh(
    run: Run, counted: dict[str, Array], stale: Set[str]
) -> tuple[Mask, Mask]:
    """Rows in which all that is stale is told again, and rows with something new."""
    again, own, fresh = np.zeros((3, len(run)), dtype=bool)
    for name in counted.keys() - COMMANDED:
        again |= np.isnan(counted[name]) & np.isfinite(run.columns[name])
        changed = np.diff(run.columns[name], prepend=np.inf) != 0
        new = changed & np.isfinite(counted[name])
        fresh |= new
        own |= new & (name in stale)
    return again & ~own, fresh


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
