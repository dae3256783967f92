"""Leaps: samples to which a column has stepped, where it does not go on like that."""

import numpy as np

from gripperd.diagnose.readings.fault import Mask
from gripperd.model.track import Array

STEP = 0.06
"""Share of its reach by which a column moves in one sample where it steps. [-]"""
ALIKE = 0.75
"""Share of a change that its neighbours have in a ramp: what settles has less. [-]"""
SLOW = 0.18
"""Time between samples in which two sensors have seen the same: cells, hoses and
regulators answer within 10 to 60 ms, three times as long is enough. [s]"""


def leaps(value: Array, reach: float, step: Array) -> Mask:
    """Tell the samples to which a column has leapt.

    Parameters
    ----------
    value
        Of one sweep, shape ``(n,)``.
    reach
        Of the column, in its unit.
    step
        Time since the sample before. A ramp in few slow samples does not leap. [s]
    """
    change = np.abs(np.diff(value))
    # At the ends of a sweep only one neighbour can tell a ramp from a step.
    around = np.pad(change, 1, constant_values=np.inf)
    beside = np.minimum(around[:-2], around[2:])
    ramps = (beside > ALIKE * change) & (step[1:] >= SLOW)
    return np.append(False, (change > STEP * reach) & ~ramps)
