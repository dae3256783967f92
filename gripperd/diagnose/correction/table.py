"""A correction as a table over the two quantities it changes fastest along."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import ceil

import numpy as np

from gripperd.diagnose.correction.offer import Correction
from gripperd.diagnose.readings.columns import Column
from gripperd.diagnose.residuals.regressors import DIRECTION
from gripperd.model.track import Array

MOST = 65
"""Places along one quantity."""


@dataclass(frozen=True, slots=True)
class CorrectionMap:
    """Values of a correction with everything else held. SI."""

    axes: tuple[Column, ...]
    """One or two quantities."""
    places: tuple[Array, ...]
    """Values of each, rising."""
    values: Array
    """In the shape of the places, NaN outside the fence."""
    stds: Array
    """Their standard deviations, likewise."""
    held: Mapping[Column, float]
    """Where the other quantities that matter are held."""


def maps(correction: Correction, fewest: int) -> tuple[CorrectionMap, ...]:
    """Draw up a correction: travelling either way, where that matters.

    Parameters
    ----------
    correction
        What to draw up.
    fewest
        Places along each quantity; more where it changes faster.
    """
    lengths = dict(zip(correction.regressors, correction.lengths, strict=True))
    if lengths.get(DIRECTION) is None:
        return (_map(correction, fewest, {}),)
    return tuple(_map(correction, fewest, {DIRECTION: way}) for way in (1.0, -1.0))


def _map(
    correction: Correction, fewest: int, chosen: Mapping[Column, float]
) -> CorrectionMap:
    usual = dict(zip(correction.regressors, correction.usual.tolist(), strict=True))
    axes = _axes(correction)
    low, high = (
        dict(zip(correction.regressors, end, strict=True))
        for end in correction.ends.tolist()
    )
    lengths = dict(zip(correction.regressors, correction.lengths, strict=True))
    places = tuple(
        _places(low[axis], high[axis], lengths[axis], fewest) for axis in axes
    )
    grid = dict(zip(axes, np.meshgrid(*places, indexing="ij"), strict=True))
    shape = tuple(place.size for place in places)
    columns = [
        grid[one] if one in grid else np.full(shape, chosen.get(one, usual[one]))
        for one in correction.regressors
    ]
    regressors = np.column_stack([column.ravel() for column in columns])
    values = correction.at(regressors)
    stds = np.where(np.isfinite(values), correction.std(regressors), np.nan)
    held = {
        one: chosen.get(one, usual[one])
        for one, length in lengths.items()
        if length is not None and one not in axes
    }
    return CorrectionMap(axes, places, values.reshape(shape), stds.reshape(shape), held)


def _places(low: float, high: float, length: float | None, fewest: int) -> Array:
    """Close enough that straight lines between them do: two to a length."""
    wanted = 1 + ceil(2 * (high - low) / length) if length else fewest
    return np.linspace(low, high, max(fewest, min(wanted, MOST)))


def _axes(correction: Correction) -> tuple[Column, ...]:
    """Two at most that matter, most telling first; a direction is no axis."""
    able = [one for one in correction.regressors if one is not DIRECTION]
    ranges = np.ptp(correction.ends, axis=0)
    turns = {
        one: length / reach
        for one, length, reach in zip(
            correction.regressors, correction.lengths, ranges, strict=True
        )
        if length is not None and one in able
    }
    return tuple(sorted(turns, key=lambda one: turns[one])[:2]) or tuple(able[:1])
