"""Quiet places of a recording, from which the drift of a sensor is read."""

import numpy as np

from gripperd.diagnose.noise.drift import Quiet, hold, repeat
from gripperd.diagnose.readings.course import Course
from gripperd.diagnose.readings.fault import Mask
from gripperd.diagnose.readings.held import longest_held
from gripperd.diagnose.readings.recording import Run
from gripperd.diagnose.readings.row import alike
from gripperd.diagnose.readings.travel import TRAVEL
from gripperd.diagnose.residuals.problem import Problem
from gripperd.model.effect import Signal
from gripperd.model.track import Array

VENTED = 0.03
"""Below this share of the highest pressure a muscle is empty. [-]"""
HELD = 0.03
"""Within this share of the highest pressure it is held. [-]"""
LONG_ENOUGH = 10.0
"""A shorter hold says nothing about drift. [s]"""
ARRIVED = 2.0
"""Time in which what has come to rest still settles. [s]"""
LEAST = 20
"""Samples of a hold that say something."""
ENOUGH = 30
"""Samples of a sweep of which a few regressors take little."""
APART = 0.01
"""Size of what regressors have not in common, from which it is one more. [-]"""
FIRST = 1.0
"""Inflations finished before any but the first. [-]"""


def vented(problem: Problem, signal: Signal) -> list[Quiet]:
    """Readings of a vented muscle that holds no force: nothing but noise."""
    if signal not in (Signal.PRESSURE, Signal.FORCE):
        return []
    top = problem.highest.get(Signal.PRESSURE, 0.0)
    found: list[Quiet] = []
    for index, course in enumerate(problem.courses):
        reading = course.column(signal.value)
        good = np.isfinite(reading) & _held(course, top)
        if problem.kept:
            good &= problem.kept[index]
        if good.sum() < LEAST or np.ptp(course.time[good]) < LONG_ENOUGH:
            continue
        if float(np.mean(course.level("pressure")[good])) < VENTED * top:
            found.append(hold(course.time[good], reading[good], creeps=False))
    return found


def driven(problem: Problem, residuals: list[Array], indices: list[int]) -> list[Quiet]:
    """What is left on pressurised holds.

    Parameters
    ----------
    problem
        The recording and the model.
    residuals
        Of every block. [SI]
    indices
        Blocks of one signal.
    """
    top = problem.highest.get(Signal.PRESSURE, 0.0)
    found: list[Quiet] = []
    for i in indices:
        block = problem.blocks[i]
        course = problem.courses[block.course]
        held = _held(course, top)[block.good]
        time = problem.times[i][held]
        if time.size < LEAST or np.ptp(time) < LONG_ENOUGH:
            continue
        pressure = course.level("pressure")[block.good][held]
        if float(np.mean(pressure)) >= VENTED * top:
            found.append(hold(time, residuals[i][held], creeps=True))
    return found


def _held(course: Course, top: float) -> Mask:
    """Samples of the longest stretch at one pressure and length, once it has come."""
    held = np.zeros(len(course), dtype=bool)
    pressure, way = course.level("pressure"), course.level("contraction")
    if not (np.isfinite(pressure).all() and top > 0):
        return held
    columns = [pressure / (HELD * top)]
    if np.isfinite(way).all():
        columns.append(way / TRAVEL)
    stretch = longest_held(np.vstack(columns))
    held[stretch] = True
    if stretch.start > 0:
        held &= course.time >= course.time[stretch.start] + ARRIVED
    return held


def repeated(
    problem: Problem, residuals: list[Array], indices: list[int], *, first: bool
) -> list[Quiet]:
    """Differences of sweeps that ask the same of the rig, the first pair of each.

    Parameters
    ----------
    problem, residuals, indices
        As of :func:`driven`.
    first
        Those of the first inflation, or all others. What it has on top may be an
        effect, not drift.
    """
    found: list[Quiet] = []
    taken: set[int] = set()
    for place, i in enumerate(indices):
        for j in indices[place + 1 :]:
            one, other = (problem.courses[problem.blocks[k].course] for k in (i, j))
            if i in taken or j in taken or not alike(_run(one), _run(other)):
                continue
            if first != (one.cycle[0] < FIRST):
                continue
            taken |= {i, j}
            here, there = _shared(problem.blocks[i].good, problem.blocks[j].good)
            if not here.any():
                continue
            load = problem.measured[i][here]
            found.append(
                repeat(
                    problem.times[i][here],
                    residuals[i][here],
                    residuals[j][there],
                    load / max(float(np.max(np.abs(load))), 1e-300),
                )
            )
    return found


def moved(problem: Problem, residuals: list[Array], indices: list[int]) -> list[Quiet]:
    """Sweeps in which jaws move, but for what their way and their pull tell of them.

    Parameters
    ----------
    problem, residuals, indices
        As of :func:`driven`.
    """
    return [
        Quiet(problem.times[i], residuals[i], _ways(problem, i))
        for i in indices
        if residuals[i].size > ENOUGH
    ]


def _ways(problem: Problem, index: int) -> Array:
    """Whatever acts in a linkage is near a sum of these; shape ``(n, k)``. [-]."""
    block = problem.blocks[index]
    course = problem.courses[block.course]
    way, pull, pressure = (
        course.level(name)[block.good] for name in ("contraction", "force", "pressure")
    )
    side = course.direction[block.good]
    ways = way, way**2, pull, pressure, side, side * way
    known = [one for one in ways if np.isfinite(one).all() and np.ptp(one) > 0]
    ones = np.ones_like(way)
    every = [ones, *((one - one.mean()) / np.ptp(one) for one in known)]
    # Of jaws that go freely way, pull and pressure are nearly the same.
    axes, sizes, _ = np.linalg.svd(np.column_stack(every), full_matrices=False)
    return np.asarray(axes[:, sizes > APART * sizes[0]])


def _shared(one: Mask, other: Mask) -> tuple[Mask, Mask]:
    """Which of the samples of each have one of the other at the same place."""
    size = min(one.size, other.size)
    both = np.zeros(max(one.size, other.size), dtype=bool)
    both[:size] = one[:size] & other[:size]
    return both[: one.size][one], both[: other.size][other]


def _run(course: Course) -> Run:
    return Run(course.run, {**course.measured, "time": course.time}, course.kind)
