"""The course of one run: what was measured, and the same without noise."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import inf

import numpy as np
from scipy.optimize import isotonic_regression

from gripperd.diagnose.noise import Noise, quick_noise
from gripperd.diagnose.recording import Kind, Recording, Run
from gripperd.diagnose.smoothing import Smooth, smooth
from gripperd.diagnose.travel import leaning, travel
from gripperd.model.compiled import compiled
from gripperd.model.memory import begin, lag
from gripperd.model.track import Array

SMOOTHED = ("pressure", "contraction", "force", "opening", "grip", "temperature")
PAUSE = 40.0
"""A gap this many sampling steps long ends one sweep and begins another."""
LATE = (1e-3, 0.03, 0.1, 0.3, 1.0)
"""Lags tried between command and pressure. [s]"""
SUPPLE = 1e4
"""A length is measured well: its corners matter more than its noise."""
TRAVEL = 1.5e-3
"""Contraction that must be undone before a travel counts as reversed. [-]"""
STILL = 4e-3
"""A sweep within this range of contraction has no travel. [-]"""
MOVES = 5e-5
"""Change of current that is a new command: 0.3 % of the span. [A]"""
LEAP = 0.02
"""Share of the range between neighbours from which points are no sweep. [-]"""
LEAST = 20
"""Samples that a plane is laid through."""
SHORTEST_PAUSE = 2.0
"""Nor is a shorter gap a pause. [s]"""


@dataclass(frozen=True, slots=True)
class Course:
    """One sweep without a pause; arrays of shape ``(n,)`` in SI, NaN not measured."""

    run: str
    kind: Kind | None
    time: Array
    step: Array
    measured: Mapping[str, Array]
    smooth: Mapping[str, Smooth]
    """Columns without noise; ``length`` is the contraction with its corners sharp."""
    cycle: Array
    repeat: Array
    direction: Array
    """Direction of travel, 0 before there was any. [-]"""
    still: Array
    """Time since the command last moved. [s]"""

    def __len__(self) -> int:
        """Number of samples."""
        return self.time.size

    def column(self, name: str) -> Array:
        """Measured column, NaN when there is none."""
        missing = np.full_like(self.time, np.nan)
        return self.measured.get(name, missing)

    def level(self, name: str) -> Array:
        """Column without its noise where that was taken off."""
        return self.smooth[name].value if name in self.smooth else self.column(name)


def courses(
    recording: Recording, rest_length: float
) -> tuple[tuple[Course, ...], Mapping[str, Noise]]:
    """Cut a recording into sweeps and take the noise off what effects look at.

    Parameters
    ----------
    recording
        Screened.
    rest_length
        L_N, to which a measured length refers. [m]

    Returns
    -------
    The sweeps in order, and the quick noise of each measured column.
    """
    sweeps = [
        piece
        for run in recording.runs
        for piece in _pieces(_with_contraction(run, rest_length))
    ]
    names = {name for sweep in sweeps for name in sweep.columns} - {"time"}
    noises = {
        name: quick_noise(
            sweep.columns[name] for sweep in sweeps if name in sweep.columns
        )
        for name in names
    }
    for name, std in recording.noise.items():
        if name in noises and std > noises[name].std:
            noises[name] = Noise(std, noises[name].correlation)
    counts = _cycles(sweeps)
    rows = _rows(sweeps)
    return tuple(
        _course(sweep, noises, cycle, repeat)
        for sweep, cycle, repeat in zip(sweeps, counts, rows, strict=True)
    ), noises


def _course(
    sweep: Run, noises: Mapping[str, Noise], cycle: Array, repeat: float
) -> Course:
    time = sweep.columns["time"]
    smoothed = {
        name: smooth(time, sweep.columns[name], noises[name].slow_variance)
        for name in SMOOTHED
        if sweep.has(name)
    }
    if "contraction" in smoothed:
        smoothed["length"] = _length(sweep, noises)
        smoothed["contraction"] = _steady(smoothed["contraction"], STILL, TRAVEL)
    if "pressure" in smoothed and sweep.has("current"):
        plain = smoothed["pressure"]
        smoothed["pressure"] = _beside_command(sweep, plain, noises)
    if {"pressure", "contraction", "force"} <= smoothed.keys():
        smoothed["force"] = _beside_pressure(sweep, smoothed, noises)
    return Course(
        sweep.name, sweep.kind, time, np.diff(time, prepend=time[0]),
        sweep.columns, smoothed, cycle, np.full(time.size, repeat),
        _directions(smoothed.get("contraction"), time), _stillness(sweep),
    )  # fmt: skip


def _steady(known: Smooth, still: float, least: float) -> Smooth:
    """Take the wiggles out: there is no travel below the least, and none back.

    What remembers would take each wiggle for a reversal. Between reversals the column
    becomes the nearest monotone one (isotonic regression).
    """
    value = known.value
    if not np.isfinite(value).all():
        return known
    signs = travel(value, least) if np.ptp(value) >= still else 0.0 * value
    cuts = [0, *(np.flatnonzero(np.diff(signs)) + 1), value.size]
    out = value.copy()
    for start, end in pairwise(cuts):
        piece, sign = slice(start, end), signs[start]
        if sign == 0:
            out[piece] = value[piece].mean()
        else:
            out[piece] = isotonic_regression(value[piece], increasing=bool(sign > 0)).x
    if not signs.any():
        return known._replace(value=out, rate=0.0 * value)
    return known._replace(value=out)


def _length(sweep: Run, noises: Mapping[str, Noise]) -> Smooth:
    """Contraction whose corners stay sharp, at the price of some noise."""
    variance = noises["contraction"].slow_variance
    time, contraction = sweep.columns["time"], sweep.columns["contraction"]
    return smooth(time, contraction, variance, SUPPLE)


def _beside_command(sweep: Run, plain: Smooth, noises: Mapping[str, Noise]) -> Smooth:
    """Pressure as the command, followed so late, plus a smooth difference.

    The command has corners that no trend can follow, and no noise. Taken when likelier
    than a trend alone.
    """
    current, pressure = sweep.columns["current"], sweep.columns["pressure"]
    good = np.isfinite(current) & np.isfinite(pressure)
    if not np.isfinite(current).all() or good.sum() < 8 or np.ptp(current) == 0:
        return plain
    slope, level = np.polyfit(current[good], pressure[good], 1)
    command = level + slope * current
    time, variance = sweep.columns["time"], noises["pressure"].slow_variance
    step = np.diff(time, prepend=time[0])
    best = plain
    for late in LATE:
        followed = lag(command, step, late, late, begin())
        beside = smooth(time, pressure - followed, variance)
        if beside.likelihood > best.likelihood:
            rate = beside.rate + np.gradient(followed, time)
            best = beside._replace(value=beside.value + followed, rate=rate)
    return best


def _beside_pressure(
    sweep: Run, known: Mapping[str, Smooth], noises: Mapping[str, Noise]
) -> Smooth:
    """Force as pressure and contraction make it, plus a smooth difference.

    Within one sweep a twisted plane for each way is close enough; it has the corners
    that no trend can follow. Taken when likelier than a trend alone.
    """
    time, force = sweep.columns["time"], sweep.columns["force"]
    pressure, contraction = known["pressure"].value, known["contraction"].value
    rubbing = leaning(pressure)
    plane = np.column_stack([
        np.ones_like(time), pressure, contraction, pressure * contraction,
        rubbing, rubbing * pressure,
    ])  # fmt: skip
    plane /= np.maximum(np.abs(plane).max(axis=0), 1e-300)
    good = np.isfinite(force) & np.isfinite(plane).all(axis=1)
    if not np.isfinite(plane).all() or good.sum() < LEAST:
        return known["force"]
    followed = plane @ np.linalg.lstsq(plane[good], force[good], rcond=1e-6)[0]
    variance = noises["force"].slow_variance
    beside = smooth(time, force - followed, variance)
    if beside.likelihood <= known["force"].likelihood:
        return known["force"]
    rate = beside.rate + np.gradient(followed, time)
    return beside._replace(value=beside.value + followed, rate=rate)


def _directions(contraction: Smooth | None, time: Array) -> Array:
    """Direction of travel, sample by sample, kept at rest.

    A travel counts once it has gone :data:`TRAVEL`, so noise does not turn it round.
    """
    if contraction is None or not np.isfinite(contraction.value).all():
        return np.zeros_like(time)
    if np.ptp(contraction.value) < STILL:
        return np.zeros_like(time)
    return travel(contraction.value, TRAVEL)


def _stillness(sweep: Run) -> Array:
    """Time since the command last moved. [s]."""
    time = sweep.columns["time"]
    if not sweep.has("current"):
        return np.full_like(time, np.nan)
    return compiled(_since)(sweep.columns["current"], time, MOVES)


def _since(value: Array, time: Array, least: float) -> Array:
    out = np.empty_like(value)
    held, since = value[0], time[0]
    for i in range(value.size):
        if abs(value[i] - held) > least:
            held, since = value[i], time[i]
        out[i] = time[i] - since
    return out


def _with_contraction(run: Run, rest_length: float) -> Run:
    if "contraction" in run.columns or "length" not in run.columns:
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
        if end - start < 4:
            continue
        name = run.name if len(cuts) == 2 else f"{run.name}#{index + 1}"
        columns = {key: value[start:end] for key, value in run.columns.items()}
        yield Run(name, columns, run.kind)


def is_table(sweeps: Sequence[Course]) -> bool:
    """Tell whether a recording lists settled points, with a counter for a clock."""
    return all(
        np.all(course.step[1:] == 1.0)
        and np.median(np.abs(np.diff(course.level("pressure"))))
        > LEAP * np.ptp(course.level("pressure"))
        for course in sweeps
    )


def _cycles(sweeps: list[Run]) -> list[Array]:
    """Inflations finished before each sample: half way up, then down to a quarter."""
    top = max((np.nanmax(_pressure(s), initial=0.0) for s in sweeps), default=0.0)
    done = 0.0
    filled = False
    counts: list[Array] = []
    for sweep in sweeps:
        pressure = _pressure(sweep)
        count = np.full(pressure.size, done)
        for index, value in enumerate(pressure):
            if value > 0.5 * top:
                filled = True
            elif filled and value < 0.25 * top:
                filled = False
                done += 1
            count[index] = done
        # The rig rests between runs, which ends an inflation.
        if filled:
            filled, done = False, done + 1
        counts.append(count)
    return counts


def _pressure(sweep: Run) -> Array:
    columns = sweep.columns
    return columns.get("pressure", columns.get("current", columns["time"] * 0))


def _rows(sweeps: list[Run]) -> list[float]:
    """How often the same sweep was run before without another between; NaN outside.

    A row is three or more: a single repeat is a check of the rig, not a row.
    """
    places: list[int] = []
    for index, sweep in enumerate(sweeps):
        follows = index > 0 and alike(sweeps[index - 1], sweep)
        places.append(places[-1] + 1 if follows else 0)
    lengths = [1] * len(places)
    for index in range(len(places) - 1, -1, -1):
        last = index + 1 >= len(places) or places[index + 1] == 0
        lengths[index] = places[index] + 1 if last else lengths[index + 1]
    return [
        float(place) if length >= 3 else np.nan
        for place, length in zip(places, lengths, strict=True)
    ]


def alike(one: Run, other: Run) -> bool:
    """Whether two sweeps ask the same of the rig: same length, inputs within 3 %."""
    n, m = len(one), len(other)
    if abs(n - m) > 0.1 * max(n, m):
        return False
    asked = ("current", "contraction") if one.has("current") else (
        "pressure", "contraction",
    )  # fmt: skip
    for name in asked:
        a, b = one.columns.get(name), other.columns.get(name)
        if a is None or b is None:
            if a is not b:
                return False
            continue
        k = min(n, m)
        reach = max(np.nanmax(np.abs(a), initial=0.0), REACH.get(name, 0.0))
        gap = np.nanmean(np.abs(a[:k] - b[:k])) if k else inf
        if not gap <= 0.03 * reach:
            return False
    return True


REACH = {"contraction": 0.1}
"""Least full scale for the comparison of sweeps. [SI]"""
