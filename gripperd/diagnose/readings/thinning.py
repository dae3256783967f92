"""Fewer rows that say the same: means of neighbours."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from gripperd.diagnose.readings.recording import Recording, Run
from gripperd.errors import InputError
from gripperd.model.track import Array


def thinned(recording: Recording, most: int) -> Recording:
    """Average whole numbers of neighbours inside runs until few enough rows remain.

    Every run is averaged alike; the rest at its end is averaged too. A reading that is
    not believed has no part in a mean. The noise that the side file states stays as it
    is, for how much a mean lowers it depends on a correlation nobody stated.

    Parameters
    ----------
    recording
        Screened: a spike would be smeared over its neighbours.
    most
        Rows to keep at most.

    Raises
    ------
    InputError
        There are more runs than rows to keep.
    """
    sizes = np.array([len(run) for run in recording.runs])
    rows = int(sizes.sum())
    if rows <= most:
        return recording
    if sizes.size > most:
        message = f"{sizes.size} runs need as many rows; {most} are to remain"
        raise InputError(message, key="most")
    width = -(-rows // most)
    while -(-sizes // width).sum() > most:
        width += 1
    runs = tuple(_averaged(run, width) for run in recording.runs)
    left = sum(len(run) for run in runs)
    remark = f"{rows} rows were averaged to {left}, {width} neighbours to one."
    return replace(recording, runs=runs, remarks=(*recording.remarks, remark))


def _averaged(run: Run, width: int) -> Run:
    starts = np.arange(0, len(run), width)
    columns = {name: _means(values, starts) for name, values in run.columns.items()}
    return replace(run, columns=columns)


def _means(values: Array, starts: NDArray[np.intp]) -> Array:
    measured = np.isfinite(values)
    count = np.add.reduceat(measured.astype(np.float64), starts)
    total = np.add.reduceat(np.where(measured, values, 0.0), starts)
    return np.where(count > 0, total / np.maximum(count, 1.0), np.nan)
