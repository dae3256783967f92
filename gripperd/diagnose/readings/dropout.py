"""Rows in which a lost link left zeros in all channels at once."""

from collections.abc import Iterator, Sequence

import numpy as np

from gripperd.diagnose.readings.fault import Fault, Mask
from gripperd.diagnose.readings.frozen import COMMANDED
from gripperd.diagnose.readings.recording import Run

REASON = "0 in all channels at once"
CHANNELS = ("pressure", "contraction", "force")
"""Of which all that there are read 0."""
FEWEST = 2
"""One channel that reads 0 may be a spike of its own."""
LONGEST = 10
"""Rows in a row."""
FAR = 0.05
"""Share of the highest pressure, or force, that stands on either side. [-]"""


def dropouts(runs: Sequence[Run]) -> Iterator[Fault]:
    """Find rows of zeros amid a sweep that is far from a vented muscle at rest."""
    for index, run in enumerate(runs):
        rows = _dropped(runs, run)
        if rows.any():
            for quantity in sorted(run.columns.keys() - COMMANDED):
                yield Fault(index, quantity, rows, REASON)


def _dropped(runs: Sequence[Run], run: Run) -> Mask:
    dropped = np.zeros(len(run), dtype=bool)
    known = [name for name in CHANNELS if run.has(name)]
    if len(known) < FEWEST:
        return dropped
    zeros = np.all([run.columns[name] == 0.0 for name in known], axis=0)
    load = next((name for name in ("pressure", "force") if name in known), None)
    if load is None:
        return dropped
    top = max(float(np.nanmax(one.columns[load])) for one in runs if one.has(load))
    stands = run.columns[load] > FAR * top
    ends = np.flatnonzero(np.diff(zeros, prepend=False, append=False))
    for start, end in ends.reshape(-1, 2).tolist():
        inside = start > 0 and end < len(run)
        if inside and end - start <= LONGEST and stands[start - 1] and stands[end]:
            dropped[start:end] = True
    return dropped
