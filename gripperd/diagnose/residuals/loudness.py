"""How loud each signal is: white noise, its memory, and drift."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType

import numpy as np

from gripperd.diagnose.noise.drift import coloured, shortened, with_drift
from gripperd.diagnose.noise.model import Noise, coarse_step, quick_noise, quieter
from gripperd.diagnose.readings.course import Course, is_table
from gripperd.diagnose.readings.fault import Mask
from gripperd.diagnose.readings.stairs import Sweep, noise_on_stairs
from gripperd.diagnose.residuals.doubt import of_length
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.residuals.quiet import driven, moved, repeated, vented
from gripperd.diagnose.residuals.ranges import ranges
from gripperd.diagnose.side_by_side import side_by_side
from gripperd.model.effect import Signal
from gripperd.model.track import Array

POINTS = 0.002
"""Noise of settled points in a table, of full scale. [-]"""
RESOLUTION = 1e-4
"""Of any reading, of full scale. [-]"""
REVERSIBLE = 0.003
"""Difference between a rising and a falling reading of the grip, of the largest, that
says nothing of the joints: reversibility of a transducer of class 1, ISO 376. [-]"""
QUIETER = 0.1
"""Share of a noise from which neighbours in a residual know better: it is told from
readings that may rise too fast for them. [-]"""
WANDERS = 0.01
"""What persists is no noise of a sensor above that share of full scale: theirs is 0.2
to 0.6 %. [-]"""
TURNS = 3.0
"""Time in which a grip that rises turns to one that falls. [s]"""


def noises_of(
    problem: Problem,
    point: Point,
    stated: Mapping[str, float] = MappingProxyType({}),
) -> dict[Signal, Noise]:
    """Tell the noise of every signal that is explained.

    Parameters
    ----------
    problem
        Without what is held out.
    point
        The best constants, with nothing added. What repeats is no noise.
    stated
        One sigma by column, as whoever measured knows it: no reading has less. [SI]

    Returns
    -------
    Noise by signal. [SI]
    """
    residuals = problem.residuals(point)
    heard = side_by_side(
        lambda signal: _noise_of(problem, residuals, signal, stated),
        problem.signals,
        problem.processes,
    )
    noises = dict(zip(problem.signals, heard, strict=True))
    return {
        signal: replace(noise, std=max(noise.std, stated.get(signal.value, 0.0)))
        for signal, noise in _handed_on(noises, problem, residuals).items()
    }


def _noise_of(
    problem: Problem,
    residuals: list[Array],
    signal: Signal,
    stated: Mapping[str, float],
) -> Noise:
    indices = [i for i, b in enumerate(problem.blocks) if b.signal is signal]
    step = coarse_step(c.column(signal.value) for c in problem.courses)
    noise = quick_noise((_share(problem, i) * residuals[i] for i in indices), step)
    if signal is Signal.PRESSURE:
        noise = _on_stairs(problem.courses) or noise
    if is_table(problem.courses):
        # Neighbours are no repeats of each other; instruments of a test stand.
        noise = Noise(POINTS * problem.full_scale[signal], 0.0)
    noise = audible(noise, signal, problem.courses)
    noise = replace(noise, std=max(noise.std, stated.get(signal.value, 0.0)))
    asked = problem, residuals, indices
    quiet = [
        *vented(problem, signal), *driven(*asked), *repeated(*asked, first=False)
    ]  # fmt: skip
    quiet = shortened(quiet or repeated(*asked, first=True))
    full_scale = problem.full_scale[signal]
    noise = with_drift(noise, quiet, full_scale)
    if is_table(problem.courses):
        return noise
    # A joint with play begins each sweep elsewhere: repeats of one differ.
    told = shortened(moved(*asked)) if signal is Signal.OPENING else quiet
    # What a force hands on to a grip is told apart from it, see below.
    own = signal is Signal.GRIP
    most = WANDERS * (full_scale if own else ranges(problem)[signal])
    noise = coloured(noise, told, most)
    return with_drift(noise, quiet, full_scale)


def _share(problem: Problem, index: int) -> float:
    """Share of the noise of a sweep that is not of its length, as a deviation. [-]."""
    block = problem.blocks[index]
    made = of_length(problem.model, problem.courses[block.course], block)
    own = problem.noises[block.signal].std ** 2
    return float(np.sqrt(own / (own + np.mean(made**2))))


def _on_stairs(sweeps: Sequence[Course]) -> Noise | None:
    return noise_on_stairs([
        Sweep(course.column("current"), course.column("pressure")) for course in sweeps
    ])  # fmt: skip


def audible(noise: Noise, signal: Signal, sweeps: tuple[Course, ...]) -> Noise:
    """Give the noise of a signal: a reading is no better than its display."""
    columns = np.concatenate([sweep.column(signal.value) for sweep in sweeps])
    top = float(np.nanmax(np.abs(columns), initial=0.0)) or 1.0
    return replace(noise, std=max(noise.std, RESOLUTION * top))


def _handed_on(
    noises: dict[Signal, Noise], problem: Problem, residuals: Sequence[Array]
) -> dict[Signal, Noise]:
    """Give the grip what is wrong with the force that it is predicted from.

    Both are compared reading by reading, so that the residual has the noise of two
    cells, and the drift of both beside what neither repeats when it turns round. Sums
    keep the variance of a reading and of a mean over many.
    """
    force, grip, linkage = (
        noises.get(Signal.FORCE), noises.get(Signal.GRIP), problem.model.linkage,
    )  # fmt: skip
    if force is None or grip is None or linkage is None:
        return noises
    handed = replace(force, std=force.std / linkage.ratio)
    both = (
        _sum(grip, handed)
        if is_table(problem.courses)
        else _of_both(problem, residuals, grip, handed)
    )
    turned = REVERSIBLE * problem.full_scale[Signal.GRIP]
    slow = np.square([grip.drift, force.drift / linkage.ratio, turned])
    memory = float(np.average([grip.memory, force.memory, TURNS], weights=slow))
    both = replace(both, drift=float(slow.sum() ** 0.5), memory=memory)
    return noises | {Signal.GRIP: both}


def _of_both(
    problem: Problem, residuals: Sequence[Array], grip: Noise, handed: Noise
) -> Noise:
    """Noise of what a grip leaves: of its own cell, and handed on by the force.

    Its own is told from its readings on an object. In a grasp these may rise so fast,
    and be so few, that neighbours tell their rise; then the residual is quieter, which
    has the noise of both and more than its own. It is as short, and so what is handed
    on is not taken off, unless it is quieter by far.
    """
    indices = [i for i, b in enumerate(problem.blocks) if b.signal is Signal.GRIP]
    blocks = [problem.blocks[i] for i in indices]
    readings = [problem.courses[b.course].column("grip")[b.good] for b in blocks]
    pieces = [
        piece
        for block, i in zip(blocks, indices, strict=True)
        for piece in _unbroken(residuals[i], block.good)
    ]
    step = coarse_step(readings)
    own, unbroken = (
        audible(quick_noise(each, step), Signal.GRIP, problem.courses)
        for each in (readings, pieces)
    )
    left = quieter(grip, unbroken)
    apart = [one.std**2 * (1 - one.correlation) for one in (left, own, handed)]
    if apart[0] < QUIETER * (apart[1] + apart[2]):
        return left
    return _sum(quieter(own, left), handed)


def _sum(one: Noise, other: Noise) -> Noise:
    fast = one.std**2 + other.std**2
    mean = one.slow_variance + other.slow_variance
    return Noise(fast**0.5, (mean - fast) / (mean + fast))


def _unbroken(values: Array, good: Mask) -> list[Array]:
    """Cut values of good samples where others lie between."""
    cuts = np.flatnonzero(np.diff(np.flatnonzero(good)) > 1) + 1
    return np.split(values, cuts)
