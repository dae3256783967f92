"""Inflations that are over, counted through a recording."""

from collections.abc import Mapping, Sequence
from types import MappingProxyType

import numpy as np

from gripperd.diagnose.readings.recording import Run
from gripperd.model.track import Array

EMPTY: Mapping[str, float] = MappingProxyType({"current": 4e-3, "pressure": 0.0})
"""What a muscle without air reads, the better witness last: the live zero of its
command, IEC 60381-1 [A], and gauge pressure. [Pa]"""

FULL, VENTED = 0.5, 0.25
"""Shares of the fullest above which a muscle is inflated, and under which it is not."""
HALF = 0.5
"""Share of its peak down to which it goes, and up from there as much, in a cycle that
does not vent it: rubber and braid tire of that as well. [-]"""


def cycles(sweeps: Sequence[Run]) -> list[Array]:
    """Inflations finished before each sample: half way up, then down to a quarter.

    One from which the pressure falls by half and doubles again is over as well: many
    test stands cycle a muscle without venting it.
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
    peak, trough = 0.0, np.inf
    counts: list[Array] = []
    nexts = [*(sweep.cut for sweep in sweeps[1:]), ""]
    for sweep, after, share in zip(sweeps, nexts, _shares(sweeps), strict=True):
        count = np.full(share.size, done)
        for index, value in enumerate(share):
            if not peak:
                peak = value if value > FULL else 0.0
            elif value < VENTED:
                done, peak, trough = done + 1, 0.0, np.inf
            elif np.isinf(trough):
                peak = max(peak, value)
                trough = value if value < HALF * peak else np.inf
            else:
                trough = min(trough, value)
                if value > max(FULL, trough / HALF):
                    done, peak, trough = done + 1, value, np.inf
            count[index] = done
        # The rig rests between runs, which ends an inflation; a pause in one does not.
        if peak and not (sweep.cut and sweep.cut == after):
            done, peak, trough = done + 1, 0.0, np.inf
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
