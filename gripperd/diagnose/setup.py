"""From a recording and a model to the problem: constants, noise, drift."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from gripperd.diagnose.constants import constants
from gripperd.diagnose.course import Course, alike, courses, is_table
from gripperd.diagnose.drift import Quiet, hold, repeat, thinned, with_drift
from gripperd.diagnose.holdout import split
from gripperd.diagnose.noise import Noise, quick_noise
from gripperd.diagnose.plausible import check_plausible
from gripperd.diagnose.polish import polished
from gripperd.diagnose.problem import Point, Problem
from gripperd.diagnose.recording import Recording, Run
from gripperd.diagnose.stages import INPUTS, Explanation
from gripperd.model.effect import Signal
from gripperd.model.track import Array

SLACK = 4.5
"""Standard deviations below which a force is not told from none."""
POINTS = 0.002
"""Noise of settled points in a table, of full scale. [-]"""
RESOLUTION = 1e-4
"""Of any reading, of full scale. [-]"""
VENTED = 0.03
"""Below this share of the highest pressure a muscle is empty. [-]"""
HELD = 0.03
"""Within this share of the highest pressure it is held. [-]"""
LINKAGE = 0.01
"""How well any linkage is known, of the largest grip: joints have play. [-]"""
WANDERS = 3.0
"""Time in which what is left of the force in the grip forgets. [s]"""
LONG_ENOUGH = 10.0
"""A shorter hold says nothing about drift. [s]"""


def problem_of(
    recording: Recording, model: Explanation, tolerances: Mapping[str, float]
) -> Problem:
    """Set up the diagnosis of one recording.

    Parameters
    ----------
    recording
        Screened.
    model
        At its nominal constants.
    tolerances
        One sigma by path, as the model file states them. [SI]

    Raises
    ------
    InputError
        When the recording cannot be about such a model.
    """
    sweeps, noises = courses(recording, model.muscle.rest_length)
    if not recording.has("contraction") and recording.has("length"):
        model = replace(model, told_length=model.muscle.rest_length)
    loud = {signal: noises[signal.value] for signal in INPUTS if signal.value in noises}
    rough = Problem(sweeps, model, (), loud, _slack(sweeps, loud))
    check_plausible(rough, recording.name)
    # What is left out later must not even tell how loud the noise is.
    scales = dict(split(rough).train.full_scale)
    if any("contraction" in sweep.measured for sweep in sweeps):
        scales[Signal.CONTRACTION] = 1.0
    resting = [i for i, sweep in enumerate(sweeps) if (sweep.direction == 0).sum() > 3]
    listed = constants(model, tolerances, scales, resting)
    problem = replace(rough, constants=listed)
    for _ in range(2):
        train = split(problem).train
        null = polished(train, Point(np.zeros(len(listed)))).point
        problem = replace(problem, noises=loud | _noises(train, null))
    return problem


def _audible(noise: Noise, signal: Signal, sweeps: tuple[Course, ...]) -> Noise:
    """A reading without any noise is still no better than its display."""
    columns = np.concatenate([sweep.column(signal.value) for sweep in sweeps])
    top = float(np.nanmax(np.abs(columns), initial=0.0)) or 1.0
    return replace(noise, std=max(noise.std, RESOLUTION * top))


def _slack(sweeps: tuple[Course, ...], noises: Mapping[Signal, Noise]) -> float:
    """Force below which a muscle that cannot push may be slack. [N].

    A rig that measures negative forces holds the muscle: then nothing is slack.
    """
    force = np.concatenate([sweep.column("force") for sweep in sweeps])
    force = force[np.isfinite(force)]
    if not force.size:
        return -np.inf
    top, std = float(np.max(force)), noises[Signal.FORCE].std
    pushes = np.mean(force < -max(SLACK * std, 0.03 * top)) > 0.004
    return -np.inf if pushes else max(SLACK * std, 0.015 * top)


def _noises(problem: Problem, point: Point) -> dict[Signal, Noise]:
    residuals = problem.residuals(point)
    found: dict[Signal, Noise] = {}
    for signal in problem.signals:
        indices = [i for i, b in enumerate(problem.blocks) if b.signal is signal]
        noise = quick_noise(residuals[i] for i in indices)
        if is_table(problem.courses):
            # Neighbours are no repeats of each other; instruments of a test stand.
            noise = Noise(POINTS * problem.full_scale[signal], 0.0)
        noise = _audible(noise, signal, problem.courses)
        quiet = thinned(
            [*_vented(problem, signal), *_quiet(problem, residuals, indices)]
        )
        found[signal] = with_drift(noise, quiet, problem.full_scale[signal])
    return _handed_on(found, problem)


def _handed_on(noises: dict[Signal, Noise], problem: Problem) -> dict[Signal, Noise]:
    """Give the grip what is wrong with the force that it is predicted from.

    That is its drift and what its noise leaves in the smooth column, beside the play
    of the joints. What lasts longest is taken for what forgets soonest: it is no part
    of a grasp that must be told from another.
    """
    force, grip, linkage = (
        noises.get(Signal.FORCE), noises.get(Signal.GRIP), problem.model.linkage,
    )  # fmt: skip
    if force is None or grip is None or linkage is None:
        return noises
    places = [block for block in problem.blocks if block.signal is Signal.GRIP]
    sweeps = [problem.courses[place.course] for place in places]
    own = quick_noise(
        sweep.column("grip")[place.good]
        for sweep, place in zip(sweeps, places, strict=True)
    )
    kept = float(np.mean([s.smooth["force"].leverage for s in sweeps]))
    wander = kept * force.slow_variance / linkage.ratio**2
    drift = grip.drift**2 + (force.drift / linkage.ratio) ** 2
    play = (LINKAGE * problem.full_scale[Signal.GRIP]) ** 2
    slow = (wander + drift + play) ** 0.5
    std = min(grip.std, own.std)
    return noises | {Signal.GRIP: Noise(std, own.correlation, slow, WANDERS)}


def _vented(problem: Problem, signal: Signal) -> list[Quiet]:
    """Readings of a vented muscle that holds no force: nothing but noise."""
    if signal not in (Signal.PRESSURE, Signal.FORCE):
        return []
    top = _top(problem)
    found: list[Quiet] = []
    for index, course in enumerate(problem.courses):
        reading = course.column(signal.value)
        good = np.isfinite(reading)
        if problem.kept:
            good &= problem.kept[index]
        if good.sum() < 20 or not _holds(course, top):
            continue
        empty = float(np.nanmean(course.level("pressure"))) < VENTED * top
        if empty and np.ptp(course.time[good]) >= LONG_ENOUGH:
            found.append(hold(course.time[good], reading[good], creeps=False))
    return found


def _quiet(problem: Problem, residuals: list[Array], indices: list[int]) -> list[Quiet]:
    top = _top(problem)
    found: list[Quiet] = []
    for i in indices:
        course = problem.courses[problem.blocks[i].course]
        time = problem.times[i]
        if not _holds(course, top) or np.ptp(time) < LONG_ENOUGH:
            continue
        if float(np.nanmean(course.level("pressure"))) >= VENTED * top:
            found.append(hold(time, residuals[i], creeps=True))
    found += _repeats(problem, residuals, indices)
    return found


def _top(problem: Problem) -> float:
    """Highest pressure. [Pa]."""
    levels = [course.level("pressure") for course in problem.courses]
    return max(
        (float(np.nanmax(p)) for p in levels if np.isfinite(p).any()), default=0.0
    )


def _holds(course: Course, top: float) -> bool:
    pressure = course.level("pressure")
    if not (np.isfinite(pressure).all() and top > 0):
        return False
    still = not course.direction.any()
    return bool(still and np.ptp(pressure) < HELD * top)


def _repeats(
    problem: Problem, residuals: list[Array], indices: list[int]
) -> list[Quiet]:
    """Differences of sweeps that ask the same of the rig, the first pair of each."""
    found: list[Quiet] = []
    taken: set[int] = set()
    for place, i in enumerate(indices):
        for j in indices[place + 1 :]:
            one, other = (problem.courses[problem.blocks[k].course] for k in (i, j))
            if i in taken or j in taken or not alike(_run(one), _run(other)):
                continue
            taken |= {i, j}
            size = min(residuals[i].size, residuals[j].size)
            load = problem.measured[i][:size]
            found.append(
                repeat(
                    problem.times[i][:size],
                    residuals[i][:size],
                    residuals[j][:size],
                    load / max(float(np.max(np.abs(load))), 1e-300),
                )
            )
    return found


def _run(course: Course) -> Run:
    return Run(course.run, {**course.measured, "time": course.time}, course.kind)
