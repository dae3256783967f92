"""Inputs without their noise: a local linear trend, as stiff as the noise allows.

Laid by :mod:`gripperd.diagnose.noise.trend`.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gripperd.diagnose.noise.corners import cornered
from gripperd.diagnose.noise.trend import RARE, cheapest, filtered, smoothed
from gripperd.model.compiled import compiled
from gripperd.model.track import Array

STIFFNESSES = 10.0 ** np.arange(-8.0, 5.0)
"""Spectral densities of the slope tried, in units of ``noise² / s³``."""
OF_LENGTH = 10.0 ** np.arange(-8.0, 11.0)
"""The same of a length: a rig may move it 3 % in 0.1 s, and read it within 0.02 %. What
passes through a valve is slower, and read worse."""
LEAP = 5.0
"""Standard deviations from what was foreseen at which a column may have leapt. [-]"""
FASTER = 10.0
"""Times the median rate with which a column that may leap begins at most. [-]"""
UNKNOWN = 1e3
"""Rate with which any other may begin. [1 / s, over the noise]"""
CORNER = RARE
"""What it costs to be stiffer or suppler from a sample on: as much. [nat]"""
SELDOM = 0.05
"""Share of leaps above which a column does not leap, it is quieter than told. [-]"""


class Smooth(NamedTuple):
    """A column without its noise, shape ``(n,)`` each."""

    value: Array
    rate: Array
    """Its time derivative, per second."""
    likelihood: float = -np.inf
    """Log density of the column, up to a constant. [nat]"""
    variance: float = 0.0
    """Of the noise that was taken off, as :func:`smooth` was told."""
    spread: float = 0.0
    """Standard deviation of the value amid the column, as the past alone has it."""
    leapt: tuple[slice, ...] = ()
    """Rows of samples to which it leapt, one after the other."""
    doubt: Array | float = 0.0
    """Standard deviation of the value, as the whole column has it."""
    broken: bool = False
    """Whether it was given every corner that can be told from noise."""
    lasting: float = 1.0
    """Times louder a mean over many samples hears its noise than one reading. [-]"""
    unsure: Array | bool = False
    """Samples of a way that may have been gone there and back, or by noise alone."""


def smooth(  # noqa: PLR0913  (a column, its noise, and what it may do)
    time: Array,
    column: Array,
    variance: float,
    supple: float = 1.0,
    leap: float = np.inf,
    *,
    bends: bool = False,
    breaks: bool = False,
    tried: Array = STIFFNESSES,
) -> Smooth:
    """Take the noise off one column of one run.

    Parameters
    ----------
    time
        Rising, shape ``(n,)``. [s]
    column
        What was measured; NaN is bridged.
    variance
        Of the noise as a mean over many samples sees it: the white variance times
        ``(1 + rho) / (1 - rho)``. The trend is as stiff as its likelihood allows.
    supple
        How much less stiff it shall be, so that corners stay sharp.
    leap
        Standard deviations from which it may leap, and be as stiff on either side.
    bends
        Whether it may be stiffer in some places than in others: between the corners of
        a staircase than at them.
    breaks
        Whether its slope may be another one from a sample on, and as stiff again.
    tried
        Stiffnesses, of which it takes the likeliest.
    """
    if variance <= 0 or column.size < 3 or not np.isfinite(column).any():
        rate = np.gradient(column, time) if column.size > 1 else np.zeros_like(column)
        return Smooth(column, rate)
    scale = np.sqrt(variance)
    scaled = (column - np.nanmean(column)) / scale
    step = np.diff(time, prepend=time[0])
    fast = UNKNOWN if np.isinf(leap) else _usual_rate(scaled, step)
    stiffness, likelihood = (
        cornered(scaled, step, tried, fast)
        if breaks
        else _stiffness(scaled, step, tried, (leap, fast), bends=bends)
    )
    stiffness = stiffness * supple
    _, states, spreads, leaps = compiled(filtered)(scaled, step, stiffness, leap, fast)
    level, slope, left = compiled(smoothed)(states, spreads, step, stiffness, leaps)
    rows = _rows(leaps > 0)
    return Smooth(
        level * scale + np.nanmean(column),
        _with_travel(slope, level, time, rows) * scale,
        float(likelihood) if np.mean(leaps > 0) < SELDOM else -np.inf,
        variance,
        float(np.sqrt(np.median(spreads[:, 0]))) * float(scale),
        rows,
        # Rounding may leave less than nothing of what begins so wide.
        np.sqrt(np.maximum(left, 0.0)) * scale,
        breaks,
    )


def _stiffness(
    scaled: Array, step: Array, tried: Array, begun: tuple[float, float], *, bends: bool
) -> tuple[Array, float]:
    """Likeliest stiffness of each sample, and its log density. [nat]."""
    laws = [
        compiled(filtered)(scaled, step, np.full(step.size, one), *begun)[0]
        for one in tried
    ]
    densities = np.stack(laws)
    path: NDArray[np.int64] = (
        compiled(cheapest)(densities, CORNER)
        if bends
        else np.full(step.size, np.argmax(densities.sum(1)))
    )
    density = compiled(filtered)(scaled, step, tried[path], *begun)[0]
    return tried[path], density.sum() - CORNER * np.count_nonzero(np.diff(path))


def _usual_rate(scaled: Array, step: Array) -> float:
    """How fast a column may begin: what leaps at once would begin with any slope."""
    known = np.isfinite(scaled)
    if known.sum() < 2:
        return UNKNOWN
    rates = np.diff(scaled[known]) / np.diff(np.cumsum(step)[known])
    return FASTER * float(np.median(np.abs(rates))) or UNKNOWN


def _with_travel(
    slope: Array, level: Array, time: Array, leapt: Sequence[slice]
) -> Array:
    """Slope that knows of leaps one way in a row: they are a way, at a rate."""
    found = slope.copy()
    for row in leapt:
        way = slice(row.start - 1, row.stop)
        if row.stop - row.start > 1 and np.ptp(np.sign(np.diff(level[way]))) == 0:
            found[row] = np.gradient(level[way], time[way])[1:]
    return found


def _rows(found: NDArray[np.bool_]) -> tuple[slice, ...]:
    ends = np.flatnonzero(np.diff(found, prepend=False, append=False))
    return tuple(slice(*pair) for pair in ends.reshape(-1, 2).tolist())
