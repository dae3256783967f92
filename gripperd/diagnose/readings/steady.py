"""Sweeps in which a pressure is held: they tell its noise, where no command does."""

from collections.abc import Sequence

import numpy as np

from gripperd.diagnose.noise.model import Noise, coarse_step, quick_noise
from gripperd.model.track import Array

HELD = 4.0
"""Variance over that of neighbours up to which a pressure is held: a noise with a
correlation of 0.6 has 2.5, and a sensor wanders. [-]"""
PRESSED = 0.1
"""Share of the highest pressure below which a muscle is vented, and its regulator at
rest: that may be quieter. [-]"""
ENTRIES = (0.0, 0.25, 0.5)
"""Shares of a sweep in which its pressure may come to where it is held. [-]"""
ENOUGH = 100
"""Samples that tell a noise and its memory."""


def noise_held(columns: Sequence[Array]) -> Noise | None:
    """Noise of a pressure in sweeps in which it is held; none where there are few.

    Brisk ramps and stairs look like a noise that remembers.

    Parameters
    ----------
    columns
        Pressures of sweeps, in order of time; NaN tells nothing. [Pa]
    """
    known = [column[np.isfinite(column)] for column in columns]
    top = max((float(np.max(one)) for one in known if one.size), default=0.0)
    held = [_held(one) for one in known if one.size and np.median(one) > PRESSED * top]
    if sum(one.size for one in held) < ENOUGH:
        return None
    return quick_noise(held, coarse_step(held))


def _held(column: Array) -> Array:
    """Give the longest end of a sweep that is held, of those that are tried."""
    for entry in ENTRIES:
        end = column[round(entry * column.size) :]
        neighbours = np.mean(np.diff(end) ** 2) / 2 if end.size > 1 else 0.0
        if np.var(end) < HELD * neighbours:
            return end
    return column[:0]
