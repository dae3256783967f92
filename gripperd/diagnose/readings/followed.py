"""What a regulator may have made of a command, so far as a trend need not know it.

References
----------
.. [1] M. Brokate, J. Sprekels, "Hysteresis and Phase Transitions", Springer, 1996,
       section 2.3: play and stop.
.. [2] G. Schwarz, "Estimating the dimension of a model", Ann. Statist. 6(2), 461-464,
       1978.
"""

from collections.abc import Iterator
from itertools import product
from typing import NamedTuple

import numpy as np

from gripperd.model.memory import begin, lag, stop
from gripperd.model.track import Array

LATE = (1e-3, 0.03, 0.1, 0.3, 1.0)
"""Lags tried between command and pressure. [s]"""
RADII = 0.003 * 1.5 ** np.arange(8)
"""Halves of the ways back over which a loop may close, of the range of the command.

Close enough: of dead bands of 10 to 40 kPa, in ramps of 400 kPa with 2.4 kPa of noise,
0.3 kPa RMS are left, as without any. [-]"""
BEFORE = (-1.0, 0.0, 1.0)
"""Whether the command went down to where it begins, rested, or went up. [-]"""
FREE = 2
"""Of a loop: its height and its radius."""


class Followed(NamedTuple):
    """A pressure that goes with the command."""

    pressure: Array
    """Shape ``(n,)``. [Pa]"""
    price: float
    """What it costs to choose it [2]_. [nat]"""


def followed(command: Array, step: Array, pressure: Array) -> Iterator[Followed]:
    """Give what to try: each lag, straight on and through a loop.

    Parameters
    ----------
    command
        In units of the pressure, known everywhere, shape ``(n,)``. [Pa]
    step
        Time since the sample before, shape ``(n,)``. [s]
    pressure
        What was measured; NaN is not known. [Pa]
    """
    price = 0.5 * FREE * float(np.log(np.isfinite(pressure).sum()))
    for late in LATE:
        yield Followed(lag(command, step, late, begin()), 0.0)
        yield Followed(_looped(command, step, late, pressure), price)


def _looped(command: Array, step: Array, late: float, pressure: Array) -> Array:
    """Command less the nearest stop [1]_ of any height, from wherever it came."""
    known = np.isfinite(pressure)
    plain = [np.ones_like(command), lag(command, step, late, begin())]
    tried = []
    for before, radius in product(BEFORE, RADII * np.ptp(command)):
        loop = stop(command, radius, command[:1] - before * radius)
        basis = np.column_stack([*plain, lag(loop, step, late, begin())])
        weights, *_ = np.linalg.lstsq(basis[known], pressure[known], rcond=1e-6)
        tried.append(np.asarray(basis @ weights))
    return min(tried, key=lambda one: float(np.sum((pressure - one)[known] ** 2)))
