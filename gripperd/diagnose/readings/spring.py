"""A muscle that is held by a spring: its length goes with its pressure."""

import numpy as np

from gripperd.diagnose.noise.smoothing import OF_LENGTH, Smooth, smooth
from gripperd.diagnose.readings.recording import Run

LEAST = 20
"""Samples through which a line is laid."""


def on_spring(sweep: Run, plain: Smooth, pressure: Smooth) -> Smooth:
    """Contraction as a spring makes it of the pressure, plus a smooth difference.

    Where a pressure has corners it has them too, and no trend can follow: it would
    begin to go before a step, and go on after it. Taken when likelier than a trend
    alone by more than the one number that it needs (Schwarz criterion).

    Parameters
    ----------
    sweep
        As it was read.
    plain
        Its contraction, as a trend alone has it. [-]
    pressure
        Without noise. [Pa]
    """
    time, column = sweep.columns["time"], sweep.columns["contraction"]
    known = np.isfinite(column) & np.isfinite(pressure.value)
    if not np.isfinite(pressure.value).all() or known.sum() < LEAST:
        return plain
    about = pressure.value - pressure.value[known].mean()
    varies = float(about[known] @ about[known])
    softness = float(about[known] @ column[known]) / varies if varies > 0 else 0.0
    # It gives way to the pull, which no pressure lessens.
    if softness <= 0:
        return plain
    made = softness * about
    beside = smooth(time, column - made, plain.variance, tried=OF_LENGTH)
    if beside.likelihood - 0.5 * np.log(known.sum()) <= plain.likelihood:
        return plain
    rate = beside.rate + softness * pressure.rate
    return beside._replace(value=beside.value + made, rate=rate)
