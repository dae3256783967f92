"""A recording cut into sweeps, each with all that is known of its course."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from gripperd.diagnose.noise.model import (
    LONG,
    Noise,
    coarse_step,
    quick_noise,
    quieter,
)
from gripperd.diagnose.noise.smoothing import Smooth
from gripperd.diagnose.readings.clamped import clamped
from gripperd.diagnose.readings.command import as_commanded, stillness
from gripperd.diagnose.readings.course import Course
from gripperd.diagnose.readings.cycle import cycles
from gripperd.diagnose.readings.frame import with_yielding_frame
from gripperd.diagnose.readings.halts import halts
from gripperd.diagnose.readings.length import wandering
from gripperd.diagnose.readings.level import levels
from gripperd.diagnose.readings.recording import Recording, Run
from gripperd.diagnose.readings.rested import with_rests
from gripperd.diagnose.readings.row import rows
from gripperd.diagnose.readings.shut import waiting
from gripperd.diagnose.readings.stairs import Sweep, noise_at_rest, noise_on_stairs
from gripperd.diagnose.readings.steady import noise_held
from gripperd.diagnose.readings.supply import supply_drops
from gripperd.diagnose.readings.table import lists_points
from gripperd.diagnose.readings.travel import JAWS, STILL, contracting
from gripperd.diagnose.readings.turn import turned
from gripperd.diagnose.side_by_side import side_by_side
from gripperd.errors import InputError
from gripperd.model.track import Array

PAUSE = 40.0
"""A gap this many sampling steps long ends one sweep and begins another."""
SHORTEST_PAUSE = 2.0
"""Nor is a shorter gap a pause. [s]"""
LEAST = 4
"""Samples of a sweep."""


def courses(
    recording: Recording, rest_length: float, processes: int = 1
) -> tuple[tuple[Course, ...], Mapping[str, Noise]]:
    """Cut a recording into sweeps and take the noise off what effects look at.

    Parameters
    ----------
    recording
        Screened.
    rest_length
        L_N, to which a measured length refers. [m]
    processes
        How many share the work.

    Returns
    -------
    The sweeps in order, and the quick noise of each measured column.

    Raises
    ------
    InputError
        When no sweep is long enough to be one.
    """
    sweeps = [
        piece
        for run in recording.runs
        for piece in _pieces(_with_contraction(run, rest_length))
    ]
    if not sweeps:
        message = (
            f"{recording.name}: no run has {LEAST} samples without a pause; samples of"
            " one sweep need the same name in column run"
        )
        raise InputError(message, key="run")
    sweeps = as_commanded(sweeps)
    noises, on_stairs = _noises(recording, sweeps, rest_length, processes)
    length = wandering(sweeps, noises.get("contraction", Noise(0.0, 0.0)))
    if "contraction" in noises:
        # Of a way that seldom is the same for long neighbours tell its turns as well.
        least = _stated(recording, rest_length).get("contraction", 0.0)
        known = quieter(length, noises["contraction"])
        noises["contraction"] = replace(known, std=max(known.std, least))
    start = min(float(sweep.columns["time"][0]) for sweep in sweeps)
    travels = side_by_side(
        lambda sweep: _travel(
            sweep, levels(sweep, noises, length, on_stairs=on_stairs)
        ),
        sweeps,
        processes,
    )
    found = [
        _course(sweep, travel, cycle, repeat, start, on_stairs=on_stairs)
        for sweep, travel, cycle, repeat in zip(
            sweeps, travels, cycles(sweeps), rows(sweeps), strict=True
        )
    ]
    if "contraction" in noises:
        found = with_yielding_frame(found, noises["contraction"])
    listed = lists_points(found)
    told = zip(found, waiting(found), supply_drops(found), clamped(found), strict=True)
    return tuple(
        replace(
            with_rests(course), waiting=wait, supply_drop=drop, clamped=clamps,
            listed=listed, halts=halts(course),
        )
        for course, wait, drop, clamps in told
    ), noises  # fmt: skip


def _noises(
    recording: Recording, sweeps: Sequence[Run], rest_length: float, processes: int
) -> tuple[dict[str, Noise], bool]:
    """Quick noise of each measured column, and whether the pressure goes in stairs."""
    names = {name for sweep in sweeps for name in sweep.columns} - {"time"}
    readings = {
        name: [sweep.columns[name] for sweep in sweeps if name in sweep.columns]
        for name in names
    }
    quick = side_by_side(
        lambda columns: quick_noise(columns, coarse_step(columns), LONG),
        tuple(readings.values()),
        processes,
    )
    noises = dict(zip(readings, quick, strict=True))
    regulated = [
        Sweep(sweep.columns["current"], sweep.columns["pressure"])
        for sweep in sweeps
        if sweep.has("current") and sweep.has("pressure")
    ]
    stepped, rest = noise_on_stairs(regulated), noise_at_rest(regulated)
    if not regulated:
        rest = noise_held(readings.get("pressure", []))
    if stepped:
        noises["pressure"] = stepped
    elif rest:
        noises["pressure"] = quieter(rest, noises["pressure"])
    for name, std in _stated(recording, rest_length).items():
        if name in noises and std > noises[name].std:
            noises[name] = Noise(std, noises[name].correlation)
    return noises, stepped is not None


def _stated(recording: Recording, rest_length: float) -> Mapping[str, float]:
    """Noise as whoever measured knows it, of the contraction as well."""
    stated = dict(recording.noise)
    if "length" in stated:
        stated.setdefault("contraction", stated["length"] / rest_length)
    return stated


def _travel(
    sweep: Run, smoothed: Mapping[str, Smooth]
) -> tuple[Mapping[str, Smooth], Array]:
    """Columns without noise, and the direction of travel that they tell. [-]."""
    time = sweep.columns["time"]
    known = smoothed.get("contraction")
    if known is None:
        return smoothed, np.zeros_like(time)
    signs = contracting(known, JAWS if sweep.has("opening") else STILL)
    found = turned(signs, time, sweep.columns["contraction"], known)
    unsure = np.logical_or(known.unsure, found.unsure)
    return {**smoothed, "contraction": known._replace(unsure=unsure)}, found.signs


def _course(
    sweep: Run,
    travel: tuple[Mapping[str, Smooth], Array],
    cycle: Array,
    repeat: float,
    start: float,
    *,
    on_stairs: bool,
) -> Course:
    time, still = sweep.columns["time"], stillness(sweep)
    smoothed, direction = travel
    return Course(
        sweep.name, sweep.kind, time, np.diff(time, prepend=time[0]),
        sweep.columns, smoothed, cycle, np.full(time.size, repeat), 0.0 * time,
        direction, still, still, 0.0 * time, 0.0 * time, on_stairs, start=start,
    )  # fmt: skip


def _with_contraction(run: Run, rest_length: float) -> Run:
    if run.has("contraction") or not run.has("length"):
        return run
    contraction = (rest_length - run.columns["length"]) / rest_length
    return Run(run.name, {**run.columns, "contraction": contraction}, run.kind)


def _pieces(run: Run) -> Iterator[Run]:
    """Cut a run at its pauses; a single piece keeps the name of the run."""
    time = run.columns["time"]
    steps = np.diff(time)
    if steps.size == 0:
        return
    long = np.flatnonzero(steps > max(PAUSE * float(np.median(steps)), SHORTEST_PAUSE))
    cuts = [0, *(long + 1), time.size]
    for index, (start, end) in enumerate(pairwise(cuts)):
        if end - start < LEAST:
            continue
        columns = {key: value[start:end] for key, value in run.columns.items()}
        if long.size:
            yield Run(f"{run.name}#{index + 1}", columns, run.kind, run.name)
        else:
            yield run
