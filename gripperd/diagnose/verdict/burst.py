"""Bursts: what comes now and then, far off for some samples, and goes again.

It hides in a noise that is taken to be as loud as all of it together, and in no order
of pressure and contraction does it show.

References
----------
.. [1] F. R. Hampel, "The influence curve and its role in robust estimation", J. Am.
       Stat. Assoc. 69(346), 383-393, 1974: the median deviation does not see them.
"""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from gripperd.diagnose.noise.model import CONSISTENT
from gripperd.diagnose.readings.course import is_table
from gripperd.diagnose.readings.fault import Mask
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.price import SEEN
from gripperd.model.effect import Signal
from gripperd.model.track import Array

OFF = 6.0
"""Standard deviations, as the median has them, from which a reading is far off: in 48
recordings of three rigs that hide no physics 6.5 was the most of any. [-]"""
IN_A_ROW = 3
"""Readings in a row, to one side: a spike is none, and is left out before."""
SWEEPS = 2
"""What happens in but one sweep is no habit of a rig."""


def bursts(problem: Problem, residuals: Sequence[Array]) -> dict[Signal, int]:
    """Count the bursts in what is left of each signal; none where they are no habit.

    Parameters
    ----------
    problem
        The recording and the model.
    residuals
        Measured minus predicted, block by block. [SI]
    """
    if is_table(problem.courses):
        return {}
    found = {}
    for signal in problem.signals:
        pairs = zip(problem.blocks, residuals, strict=True)
        own = [(block, left) for block, left in pairs if block.signal is signal]
        every = np.concatenate([left for _, left in own])
        spread = CONSISTENT * float(np.median(np.abs(every - np.median(every))))
        far = max(OFF * spread, SEEN * problem.full_scale[signal])
        counts = [_count(left, block.good, far) for block, left in own]
        if np.count_nonzero(counts) >= SWEEPS:
            found[signal] = sum(counts)
    return found


def _count(left: Array, good: Mask, far: float) -> int:
    """Stretches of readings that follow each other, all far off to one side."""
    side = np.zeros(good.size)
    side[good] = np.sign(left) * (np.abs(left) > far)
    ends = np.flatnonzero(np.diff(side, prepend=0.0, append=0.0))
    return sum(bool(side[a]) and b - a >= IN_A_ROW for a, b in pairwise(ends.tolist()))
