"""First and last readings of a run that belong to another moment.

A buffer that was not emptied gives what stood in it; a reading at an end has but one
neighbour to be told from as a spike.
"""

from collections.abc import Iterator, Sequence

import numpy as np

from gripperd.diagnose.readings.fault import Fault
from gripperd.diagnose.readings.frozen import COMMANDED
from gripperd.diagnose.readings.recording import Run
from gripperd.model.track import Array

REASON = "jumps where its run begins or ends"
FEWEST = 20
"""Readings that tell how far neighbours of a run are apart."""
OFTEN = 0.98
"""Quantile of the steps between neighbours that stands for the largest common one."""
FAR = 5.0
"""Times that from which the step at an end is none of the run. [-]"""
ENDS = ((0, 1), (-1, -2))
"""Rows that are looked at, and their neighbours."""


def edges(runs: Sequence[Run]) -> Iterator[Fault]:
    """Find readings at the ends of runs that no command has made jump there."""
    for index, run in enumerate(runs):
        stepped = [
            run.has("current") and _jumps(run.columns["current"], *end) for end in ENDS
        ]
        ends = [end for end, one in zip(ENDS, stepped, strict=True) if not one]
        for quantity in sorted(run.columns.keys() - COMMANDED):
            rows = np.zeros(len(run), dtype=bool)
            for row, neighbour in ends:
                rows[row] = _jumps(run.columns[quantity], row, neighbour)
            if rows.any():
                yield Fault(index, quantity, rows, REASON)


def _jumps(column: Array, row: int, neighbour: int) -> bool:
    if np.isfinite(column).sum() < FEWEST:
        return False
    steps = np.abs(np.diff(column[1:-1]))
    steps = steps[np.isfinite(steps)]
    if not steps.size:
        return False
    # A slow channel stands for long, and then goes on by a step of its converter.
    least = steps[steps > 0].min() if steps.any() else 0.0
    usual = max(float(np.quantile(steps, OFTEN)), float(least))
    return bool(abs(column[row] - column[neighbour]) > FAR * usual)
