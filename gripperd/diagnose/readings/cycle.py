"""Inflations that are over, counted through a recording."""

from collections.abc import Sequence

import numpy as np

from gripperd.diagnose.readings.recording import Run
from gripperd.model.track import Array


def cycles(sweeps: Sequence[Run]) -> list[Array]:
    """Inflations finished before each sample: half way up, then down to a quarter.

    Parameters
    ----------
    sweeps
        In order of time.

    Returns
    -------
    One array for each sweep, shape ``(n,)``.
    """
    top = max((np.nanmax(_pressure(s), initial=0.0) for s in sweeps), default=0.0)
    done = 0.0
    filled = False
    counts: list[Array] = []
    for sweep in sweeps:
        pressure = _pressure(sweep)
        count = np.full(pressure.size, done)
        for index, value in enumerate(pressure):
            if value > 0.5 * top:
                filled = True
            elif filled and value < 0.25 * top:
                filled = False
                done += 1
            count[index] = done
        # The rig rests between runs, which ends an inflation.
        if filled:
            filled, done = False, done + 1
        counts.append(count)
    return counts


def _pressure(sweep: Run) -> Array:
    columns = sweep.columns
    return columns.get("pressure", columns.get("current", columns["time"] * 0))
