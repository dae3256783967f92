"""Inflations that are over, counted through a recording."""

from collections.abc import Mapping, Sequence
from types import MappingProxyType

import numpy as np

from gripperd.diagnose.readings.recording import Run
from gripperd.model.track import Array

EMPTY: Mapping[str, float] = MappingProxyType({"current": 4e-3, "pressure": 0.0})
"""What a muscle without air reads, the better witness last: the live zero of its
command, IEC 60381-1 [A], and gauge pressure. [Pa]"""


def cycles(sweeps: Sequence[Run]) -> list[Array]:
    """Inflations finished before each sample: half way up, then down to a quarter.

    Where the pressure was not measured, the command tells.

    Parameters
    ----------
    sweeps
        In order of time.

    Returns
    -------
    One array for each sweep, shape ``(n,)``.
    """
    done = 0.0
    filled = False
    counts: list[Array] = []
    for share in _shares(sweeps):
        count = np.full(share.size, done)
        for index, value in enumerate(share):
            if value > 0.5:
                filled = True
            elif filled and value < 0.25:
                filled = False
                done += 1
            count[index] = done
        # The rig rests between runs, which ends an inflation.
        if filled:
            filled, done = False, done + 1
        counts.append(count)
    return counts


def _shares(sweeps: Sequence[Run]) -> list[Array]:
    """How full the muscle is, of its fullest; 0 where nothing tells. [-]."""
    found = [np.zeros(len(sweep)) for sweep in sweeps]
    for name, empty in EMPTY.items():
        told = {
            place: sweep.columns[name] - empty
            for place, sweep in enumerate(sweeps)
            if sweep.has(name)
        }
        tops = [float(np.nanmax(column)) for column in told.values()]
        top = max([0.0, *tops]) or np.inf
        for place, column in told.items():
            found[place] = column / top
    return found
