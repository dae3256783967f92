"""Where simulation and measurement disagree: runs, regions, size and significance.

References
----------
.. [1] S. Holm, "A simple sequentially rejective multiple test procedure", Scand. J.
       Statist. 6(2), 65-70, 1979.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import erfc

import numpy as np
from numpy.typing import NDArray

from gripperd.diagnose.readings.course import Course
from gripperd.diagnose.readings.travel import SURE, travel
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.verdict.region import Region
from gripperd.model.effect import Signal
from gripperd.model.track import Array

PIECES = 8
"""Stretches into which a sweep is cut at most."""
FEWEST = 4
"""Samples of a stretch."""
RIPPLE = 0.02
"""Way of a pressure, of its highest, that turns no sweep round. [-]"""
LEVEL = 0.01
"""Chance of any false finding in a whole recording."""
STAGES: Mapping[Signal, str] = {
    Signal.PRESSURE: "valve",
    Signal.FORCE: "muscle",
    Signal.OPENING: "gripper",
    Signal.GRIP: "gripper",
}
LIMITS = ("pressure", "contraction", "temperature")


@dataclass(frozen=True, slots=True)
class Finding:
    """A stretch of one sweep in which the model is off."""

    stage: str
    signal: Signal
    run: str
    region: Region
    """Lowest and highest of time, pressure, contraction, direction... [SI]; that of the
    pressure where the sweep was cut by it."""
    bias: float
    """Measured minus predicted, mean. [SI]"""
    std: float
    """Standard error of the bias. [SI]"""
    p_value: float
    """Chance of such a bias, for how many stretches were looked at (Holm [1]_). [-]"""


def findings(*examined: tuple[Problem, Sequence[Array]]) -> tuple[Finding, ...]:
    """Name the stretches in which residuals are no noise, largest bias first.

    Parameters
    ----------
    examined
        Parts of one recording under the recalibrated model, each with its residuals,
        measured minus predicted, block by block. [SI]
    """
    cells = [
        cell
        for problem, residuals in examined
        for index, residual in enumerate(residuals)
        for cell in _cells(problem, index, residual)
    ]
    order = np.argsort([cell.p_value for cell in cells])
    kept: list[Finding] = []
    worst = 0.0
    for rank, place in enumerate(order):
        cell = cells[place]
        worst = max(worst, min(1.0, cell.p_value * (len(cells) - rank)))
        if worst > LEVEL:
            break
        kept.append(_with_p(cell, worst))
    joined = _joined(kept)
    scale = examined[0][0].full_scale
    return tuple(sorted(joined, key=lambda one: -abs(one.bias) / scale[one.signal]))


def _cells(problem: Problem, index: int, residual: Array) -> Iterator[Finding]:
    block, shares = problem.blocks[index], problem.shares[index]
    course = problem.courses[block.course]
    noise = problem.noises[block.signal]
    chosen = np.flatnonzero(block.good)
    name, turning = _turning(course, block.signal, problem.highest)
    for piece in _stretches(turning[chosen]):
        loud = noise.slow_variance * np.mean(1 / shares[piece] ** 2)
        slow = loud / piece.size + noise.drift**2
        std = float(np.sqrt(slow))
        bias = float(np.mean(residual[piece]))
        p_value = float(erfc(abs(bias) / std / 2**0.5))
        region = _region(course, chosen[piece])
        region[name] = _ends(turning[chosen[piece]])
        yield Finding(
            STAGES[block.signal], block.signal, course.run, region, bias, std, p_value
        )


def _turning(
    course: Course, signal: Signal, highest: Mapping[Signal, float]
) -> tuple[str, Array]:
    """What goes there and back in a sweep, and the sign of its way.

    What lags or rubs is off one way there and the other way back.
    """
    pressure, top = course.level("pressure"), highest.get(Signal.PRESSURE, 0.0)
    travels = signal is not Signal.PRESSURE and course.direction.any()
    if travels or not (np.isfinite(pressure).all() and top > 0):
        return "direction", course.direction
    least = max(RIPPLE * top, SURE * course.hush("pressure"))
    return "pressure_direction", travel(pressure, least)


def _stretches(turning: Array) -> list[NDArray[np.intp]]:
    """Cut a sweep where it turns, and each way into as many as it is long.

    Ways of a cycle that goes on are looked at together, all there and all back.
    """
    size = turning.size
    most = min(PIECES, size // FEWEST)
    if not most:
        return []
    turns = np.flatnonzero(np.diff(turning)) + 1
    ways = np.split(np.arange(size), turns)
    if len(ways) > most:
        ways = [np.flatnonzero(turning == sign) for sign in (1.0, -1.0, 0.0)]
    long = [way for way in ways if way.size >= FEWEST]
    if not 0 < len(long) <= most:
        long = [np.arange(size)]
    return [
        piece
        for way in long
        for piece in np.array_split(way, max(1, round(most * way.size / size)))
    ]


def _region(
    course: Course, samples: NDArray[np.intp]
) -> dict[str, tuple[float, float]]:
    region = {"time": _ends(course.time[samples])}
    for name in LIMITS:
        column = course.level(name)[samples]
        if np.isfinite(column).any():
            region[name] = _ends(column)
    region["direction"] = _ends(course.direction[samples])
    return region


def _ends(column: Array) -> tuple[float, float]:
    return float(np.nanmin(column)), float(np.nanmax(column))


def _with_p(cell: Finding, p_value: float) -> Finding:
    return Finding(
        cell.stage, cell.signal, cell.run, cell.region, cell.bias, cell.std, p_value
    )


def _joined(kept: Sequence[Finding]) -> list[Finding]:
    """Neighbouring stretches of one run that are off the same way become one."""
    out: list[Finding] = []
    for cell in sorted(kept, key=lambda one: (_kind(one), one.region["time"])):
        last = out[-1] if out else None
        if last is not None and _kind(last) == _kind(cell) and _adjoin(last, cell):
            out[-1] = _union(last, cell)
        else:
            out.append(cell)
    return out


def _kind(one: Finding) -> tuple[str, Signal, bool]:
    return one.run, one.signal, one.bias > 0


def _adjoin(one: Finding, next_one: Finding) -> bool:
    start, end = next_one.region["time"]
    return start - one.region["time"][1] < 0.5 * (end - start)


def _union(one: Finding, other: Finding) -> Finding:
    widths = [f.region["time"][1] - f.region["time"][0] + 1e-9 for f in (one, other)]
    bias = float(np.average([one.bias, other.bias], weights=widths))
    region = {
        name: (
            min(one.region[name][0], other.region[name][0]),
            max(one.region[name][1], other.region[name][1]),
        )
        for name in one.region
        if name in other.region
    }
    return Finding(
        one.stage, one.signal, one.run, region, bias,
        min(one.std, other.std), min(one.p_value, other.p_value),
    )  # fmt: skip
