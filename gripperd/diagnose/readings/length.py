"""Noise of a length that wanders under white noise: it is seen where it is held.

Neighbours cannot tell how far, and where a sweep travels its way covers it. What a
trend makes of it there looks like a way that was gone, and back.
"""

from collections.abc import Iterable
from dataclasses import replace

import numpy as np
from scipy.ndimage import uniform_filter1d

from gripperd.diagnose.noise.drift import Quiet, coloured, shortened, with_drift
from gripperd.diagnose.noise.model import Noise
from gripperd.diagnose.noise.smoothing import Smooth
from gripperd.diagnose.readings.held import longest_held
from gripperd.diagnose.readings.recording import Run
from gripperd.diagnose.readings.travel import STILL, TRAVEL

NEIGHBOURS = 25
"""Samples in the mean of which noise is not taken for travel."""
LEAST = 60
"""Samples of a stretch that say how far noise wanders."""
MOST = 0.01
"""Share of the largest contraction above which what persists is no noise. [-]"""


def wandering(sweeps: Iterable[Run], noise: Noise) -> Noise:
    """Give the noise of a contraction the colour that it has where it is held.

    Parameters
    ----------
    sweeps
        Without a pause. Where jaws are moved no muscle is held.
    noise
        As its neighbours tell. [-]
    """
    ways = [
        sweep
        for sweep in sweeps
        if sweep.has("contraction") and not sweep.has("opening")
    ]
    quiet = shortened(one for sweep in ways for one in _held(sweep))
    if not quiet or noise.std <= 0:
        return noise
    top = max(float(np.nanmax(sweep.columns["contraction"])) for sweep in ways)
    drifting = with_drift(noise, quiet, top)
    return replace(coloured(drifting, quiet, MOST * top), drift=noise.drift)


def _held(sweep: Run) -> list[Quiet]:
    """Give the longest stretch without travel, but for its trend, and its force's."""
    way = sweep.columns["contraction"]
    if way.size < LEAST or not np.isfinite(way).all():
        return []
    mean = uniform_filter1d(way, NEIGHBOURS, mode="nearest")
    held = longest_held(mean[None] / (STILL * TRAVEL))
    count = held.stop - held.start
    if count < LEAST:
        return []
    # A slow sweep takes long to leave the range, at its turn as well.
    along = np.linspace(-1.0, 1.0, count)
    regressors = [np.ones(count), along, along**2]
    if sweep.has("force"):
        pull = sweep.columns["force"][held]
        if np.isfinite(pull).all() and np.ptp(pull) > 0:
            regressors.append((pull - pull.mean()) / np.ptp(pull))
    time = sweep.columns["time"][held]
    return [Quiet(time, way[held], np.column_stack(regressors))]


def as_unsure(known: Smooth, noise: Noise) -> Smooth:
    """Let a trend be as unsure of its ways as a noise leaves it that wanders.

    It wanders in full with the trend, and no further, beside what is left of the white
    noise.

    Parameters
    ----------
    known
        Trend of a contraction, as stiff as the neighbours of readings ask.
    noise
        As :func:`wandering` has it.
    """
    if known.variance <= 0:
        return known
    louder = max(noise.slow_variance / known.variance, 1.0)
    most = noise.std**2 * (1 - noise.white) + known.spread**2
    spread = min(louder * known.spread**2, most) ** 0.5
    return known._replace(spread=spread, variance=louder * known.variance)


def at_its_mean(known: Smooth) -> Smooth:
    """Give a length that does not travel: it has no corners, and a mean of readings."""
    doubt = (known.variance / known.value.size) ** 0.5
    return known._replace(doubt=doubt)
