"""What is left after the best explanation: noise, or structure nobody named.

Whitened residuals of a right explanation are independent with unit variance in any
order. They are looked at in the order of time, pressure and contraction, plain and
times the direction of travel, and in cells of pressure and contraction: slow components
have a chi-square sum when nothing is left. Fast waves are looked for as well.

References
----------
.. [1] J. D. Hart, "Nonparametric Smoothing and Lack-of-Fit Tests", Springer, 1997,
       chapter 7: tests on cosine coefficients.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import chdtrc

from gripperd.diagnose.noise.ripple import ripple
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.residuals.ranges import ranges
from gripperd.model.effect import Signal
from gripperd.model.track import Array

WAVES = 24
"""Slow components looked at along pressure and contraction."""
TIME = "time"
"""Way of looking at what nothing else is behind."""
SLOW = 12
"""Slow components looked at along time, in each sweep."""
VISIBLE = 0.0015
"""Structure below this share of full scale is what common sensors drift. [-]"""
WANDERS = 0.003
"""How far readings wander in a sweep, of the ranges of sensors: sound ones drift by
0.2 % (sd), and noise of 0.6 % that lasts for seconds is seen in their means too. [-]"""


@dataclass(frozen=True, slots=True)
class Structure:
    """One way of looking at what is left."""

    signal: Signal
    along: str
    """``time``, ``pressure``, ``contraction``, those times the direction, or a wave."""
    excess: float
    """Sum of squares above what noise has. [-]"""
    p_value: float
    """Chance of such an excess in noise. [-]"""
    size: float
    """Root mean square of the excess, of full scale, or what is slow of the ranges of
    the sensors behind it. [-]"""
    share: float
    """Largest single component of the sum: a line rather than a bend. [-]"""
    wanders: float = 0.0
    """What of the size are sensors that wander. In one sweep, all goes with time; each
    of several wanders another way. [-]"""


def structures(problem: Problem, residuals: Sequence[Array]) -> tuple[Structure, ...]:
    """Look at residuals in every order, most significant first.

    Parameters
    ----------
    problem
        The recording and the model; its noise whitens the residuals.
    residuals
        Measured minus predicted, block by block. [SI]
    """
    white = [
        problem.white([residual], index)[:, 0]
        for index, residual in enumerate(residuals)
    ]
    found = [
        _structure(problem, signal, along, components)
        for signal in problem.signals
        for along, components in _views(problem, white, signal)
    ]
    found += [
        _ripple(problem, white, signal)
        for signal in problem.signals
        if not (problem.band and signal is Signal.PRESSURE)
    ]
    return tuple(sorted(found, key=lambda one: one.p_value))


def loudness(problem: Problem, residuals: Sequence[Array]) -> dict[Signal, float]:
    """Give the mean square of what is left of each signal; 1 of its noise. [-].

    Parameters
    ----------
    problem, residuals
        As of :func:`structures`.
    """
    found: dict[Signal, list[Array]] = {}
    for index, (block, residual) in enumerate(
        zip(problem.blocks, residuals, strict=True)
    ):
        white = problem.white([residual], index)[:, 0]
        found.setdefault(block.signal, []).append(white**2)
    return {
        signal: float(np.mean(np.concatenate(squares)))
        for signal, squares in found.items()
    }


def _structure(
    problem: Problem, signal: Signal, along: str, components: Array
) -> Structure:
    squares = components**2
    total = float(squares.sum())
    count = squares.size
    return Structure(
        signal,
        along,
        total - count,
        chi_square_tail(total, count),
        _size(problem, signal, total - count),
        float(squares.max()) / total if total > 0 else 0.0,
        WANDERS if along == TIME else WANDERS / _sweeps(problem, signal) ** 0.5,
    )


def _sweeps(problem: Problem, signal: Signal) -> int:
    return sum(block.signal is signal for block in problem.blocks)


def _ripple(problem: Problem, white: Sequence[Array], signal: Signal) -> Structure:
    indices = [i for i, b in enumerate(problem.blocks) if b.signal is signal]
    wave = ripple(
        [white[i] for i in indices],
        [problem.times[i] for i in indices],
        problem.noises[signal],
    )
    samples = sum(white[i].size for i in indices)
    return Structure(
        signal,
        f"time, at {wave.frequency:.1f} Hz",
        # By its size, as all that is slow: noise may have hardly any power so fast.
        samples * wave.amplitude**2 / problem.noises[signal].slow_variance,
        wave.p_value,
        wave.amplitude / problem.full_scale[signal],
        1.0,
    )


def _size(problem: Problem, signal: Signal, excess: float) -> float:
    samples = sum(
        measured.size
        for block, measured in zip(problem.blocks, problem.measured, strict=True)
        if block.signal is signal
    )
    loud = problem.noises[signal].slow_variance
    return float((max(excess, 0.0) / samples * loud) ** 0.5) / ranges(problem)[signal]


def _views(
    problem: Problem, white: Sequence[Array], signal: Signal
) -> Iterator[tuple[str, Array]]:
    indices = [i for i, b in enumerate(problem.blocks) if b.signal is signal]
    yield TIME, np.concatenate([_cosines(white[i], SLOW) for i in indices])
    # A reading is no regressor of its own residual: they share their noise.
    first = "current" if signal is Signal.PRESSURE else "pressure"
    pieces = {
        name: np.concatenate([_level(problem, i, name) for i in indices])
        for name in (first, "contraction", "temperature")
    }
    sign = np.concatenate([_level(problem, i, "direction") for i in indices])
    left = np.concatenate([white[i] for i in indices])
    for name, column in pieces.items():
        if not np.isfinite(column).all() or np.ptp(column) == 0:
            continue
        order = np.argsort(column, kind="stable")
        yield name, _cosines(left[order], WAVES)
        moving = order[sign[order] != 0]
        if moving.size > 3 * WAVES:
            yield f"{name} x direction", _cosines((left * sign)[moving], WAVES)
    yield "cells", _cells(left, pieces[first], pieces["contraction"])


def _level(problem: Problem, index: int, name: str) -> Array:
    block = problem.blocks[index]
    course = problem.courses[block.course]
    if name == "direction":
        return course.direction[block.good]
    return course.level(name)[block.good]


def _cosines(values: Array, count: int) -> Array:
    """First coefficients of the orthonormal cosine transform (DCT-II)."""
    n = values.size
    count = min(count, n // 3)
    phase = np.pi * (np.arange(n) + 0.5) / n
    rows = np.array([np.cos(k * phase) @ values for k in range(count)])
    return rows * np.sqrt(np.where(np.arange(count) == 0, 1.0, 2.0) / n)


def _cells(left: Array, pressure: Array, contraction: Array) -> Array:
    """Sum in each cell of a 6 x 6 map, over the root of its count."""
    if not (np.isfinite(pressure).all() and np.isfinite(contraction).all()):
        return np.empty(0)
    rows = np.digitize(pressure, np.quantile(pressure, np.linspace(0, 1, 7)[1:-1]))
    columns = np.digitize(
        contraction, np.quantile(contraction, np.linspace(0, 1, 7)[1:-1])
    )
    cell = rows * 6 + columns
    sums = np.bincount(cell, left, minlength=36)
    counts = np.bincount(cell, minlength=36)
    return np.asarray(sums[counts > 20] / np.sqrt(counts[counts > 20]))


def chi_square_tail(total: float, count: int) -> float:
    """Chance that a chi-square with so many degrees of freedom is larger."""
    return float(chdtrc(count, total)) if count else 1.0
