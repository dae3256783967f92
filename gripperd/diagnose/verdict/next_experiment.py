"""Which sweep would tell two rivals apart, for the least time on the rig.

References
----------
.. [1] W. G. Hunter, A. M. Reiner, "Designs for discriminating between two rival
       models", Technometrics 7(3), 307-323, 1965.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from gripperd.diagnose.fit.polish import slopes
from gripperd.diagnose.fit.rival import Rival
from gripperd.diagnose.noise.smoothing import Smooth
from gripperd.diagnose.readings.command import stillness
from gripperd.diagnose.readings.course import Course
from gripperd.diagnose.readings.recording import Kind, Run
from gripperd.diagnose.readings.rested import with_rests
from gripperd.diagnose.readings.travel import contracting
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.verdict.key import plain
from gripperd.model.effect import Signal
from gripperd.model.track import Array

SAMPLING = 0.1
"""Time between samples of a planned sweep. [s]"""
FAR = (0.1, 0.22)
"""Contraction that a plan goes to at least, as any muscle does, and at most. [-]"""
WORTH = 9.0
"""Rise of chi² below which a sweep does not tell the rivals apart: 3 sigma. [-]"""


class Sweep(NamedTuple):
    """A sweep the rig can run: pressure and contraction over time."""

    kind: Kind
    title: str
    time: Array
    """Shape ``(n,)``. [s]"""
    pressure: Array
    """Shape ``(n,)``. [Pa]"""
    contraction: Array
    """Shape ``(n,)``. [-]"""
    warmer: float = 0.0
    """Above the temperature of the recording. [K]"""


@dataclass(frozen=True, slots=True)
class Proposal:
    """The sweep that separates best, or none that would."""

    kind: Kind | None
    why: str
    """What it tells apart, or that nothing does."""
    title: str
    """What to do, in words; empty without a sweep."""
    plan: Mapping[str, object]
    """Corner points by the columns of a recording, in their units."""


def proposal(
    problem: Problem, one: Rival, other: Rival, margin: float = 0.0
) -> Proposal:
    """Choose the sweep that maximises expected separation per second [1]_.

    Parameters
    ----------
    problem
        What was measured so far.
    one, other
        Two explanations of it.
    margin
        Evidence by which one may be behind and fit as well, so far. A sweep that rises
        by less leaves them where they are. [nat]
    """
    worth = max(WORTH, 2 * margin)
    names = f"{_title(one, other)} from {_title(other, one)}"
    top, far = _reach(problem, one)
    planned = [
        (sweep, _separations(problem, sweep, one, other))
        for sweep in _sweeps(problem, top, far)
    ]
    # One that tells whichever is true; else one that does if what bends more is.
    for does, rise in (("separates", min), ("may separate", max)):
        rates = [
            (rise(rises) / float(sweep.time[-1]), sweep)
            for sweep, rises in planned
            if rise(rises) > worth
        ]
        if rates:
            _, sweep = max(rates, key=lambda known: known[0])
            return Proposal(sweep.kind, f"{does} {names}", sweep.title, _plan(sweep))
    why = (
        f"no sweep that was tried, up to {top / 1e3:.0f} kPa and a contraction of"
        f" {far:.3g}, tells {names}: go further, measure one of them on its own, or"
        " check the sensors with a reference"
    )
    return Proposal(None, why, "", {})


def _title(one: Rival, other: Rival) -> str:
    own = [plain(name) for name in one.names if name not in other.names]
    return " and ".join(own or ["the model without it"])


def _separations(
    problem: Problem, sweep: Sweep, one: Rival, other: Rival
) -> tuple[float, float]:
    """Rise of the misfit of each rival if the other is true, after refitting."""
    return _rise(problem, sweep, one, other), _rise(problem, sweep, other, one)


def _rise(problem: Problem, sweep: Sweep, rival: Rival, true: Rival) -> float:
    course = _course(problem, sweep)
    planned = replace(problem, courses=(course,), kept=(), dwells=(), slack=-np.inf)
    if np.isfinite(problem.slack):
        # Of a muscle that cannot push no sample tells in which it is slack.
        read = _read(planned, true)
        measured = {**course.measured, **read}
        smooth = {
            name: level for name, level in course.smooth.items() if name not in read
        }
        taut = replace(course, measured=measured, smooth=smooth)
        planned = replace(planned, courses=(taut,), slack=problem.slack)
    if not planned.blocks:
        return 0.0
    a = planned.expected(planned.explanation(rival.fit.point))
    b = planned.expected(planned.explanation(true.fit.point))
    apart = np.concatenate(
        [
            planned.white([x - y], i)[:, 0]
            for i, (x, y) in enumerate(zip(a, b, strict=True))
        ]
    )
    columns = slopes(planned, rival.fit.point, rival.fit.coordinates)
    known = np.linalg.inv(rival.fit.posterior)
    moments = columns.T @ apart
    refit = np.linalg.solve(known + columns.T @ columns, moments)
    return float(apart @ apart - moments @ refit)


def _read(planned: Problem, true: Rival) -> dict[str, Array]:
    """Give the force that a cell would read, by the name of its column. [N]."""
    found: dict[str, Array] = {}
    expected = planned.expected(planned.explanation(true.fit.point))
    for block, force in zip(planned.blocks, expected, strict=True):
        if block.signal is Signal.FORCE:
            found["force"] = np.full(len(planned.courses[0]), np.nan)
            found["force"][block.good] = force
    return found


def _course(problem: Problem, sweep: Sweep) -> Course:
    regulator = problem.model.regulator
    columns = {"pressure": sweep.pressure, "contraction": sweep.contraction}
    if regulator is not None:
        columns["current"] = np.asarray(regulator.current(sweep.pressure))
    known = problem.courses[0]
    for name in ("temperature", "supply", "ambient"):
        level = known.level(name)
        if np.isfinite(level).any():
            columns[name] = np.full_like(sweep.time, np.nanmean(level))
    if "temperature" in columns:
        columns["temperature"] = columns["temperature"] + sweep.warmer
    columns["force"] = 100.0 + 0.0 * sweep.time
    end = max(float(course.time[-1]) for course in problem.courses) + 60.0
    smooth = {
        name: Smooth(column, np.gradient(column, sweep.time))
        for name, column in columns.items()
        if name not in ("current", "supply", "ambient")
    }
    still = stillness(Run(sweep.title, {**columns, "time": sweep.time}, sweep.kind))
    nothing = np.full_like(sweep.time, np.nan)
    planned = Course(
        sweep.title, sweep.kind, sweep.time + end, np.diff(sweep.time, prepend=0.0),
        columns, smooth, problem.courses[-1].cycle[-1] + 1 + 0 * sweep.time, nothing,
        0 * sweep.time, contracting(smooth["contraction"]), still, still,
        0 * sweep.time, 0 * sweep.time, start=known.start,
    )  # fmt: skip
    return with_rests(planned)


def _reach(problem: Problem, told: Rival) -> tuple[float, float]:
    """How far a rig can go: as it was seen to, and as its regulator can. [Pa], [-]."""
    pressures = [c.level("pressure") for c in problem.courses]
    tops = [float(np.nanmax(p)) for p in pressures if np.isfinite(p).any()]
    top = max(tops, default=4e5)
    if regulator := problem.explanation(told.fit.point).regulator:
        top = min(top, regulator.pressure_high)
    lengths = [c.level("contraction") for c in problem.courses]
    longest = [float(np.nanmax(h)) for h in lengths if np.isfinite(h).any()]
    far = float(np.clip(max(longest, default=0.2), *FAR))
    if problem.is_blind and (linkage := problem.model.linkage):
        # No muscle in a gripper goes beyond jaws that have met.
        met = linkage.contraction(0.0, problem.model.muscle.rest_length)
        far = min(far, float(met))
    return top, far


def _sweeps(problem: Problem, top: float, far: float) -> Iterator[Sweep]:
    """Sweeps any such rig can run, up to a pressure and a contraction."""
    for share in (0.0, 0.5, 1.0):
        for duration in (20.0, 60.0):
            yield _ramp(Kind.ISOMETRIC, top, share * far, duration)
    yield _ramp(Kind.ISOMETRIC, 0.12 * top, 0.0, 30.0)
    for share in (0.3, 0.8):
        for duration in (8.0, 40.0):
            yield _cycle(share * top, far, duration)
        yield _nested(share * top, far)
    yield _step(0.8 * top, 0.3 * far)
    if any(np.isfinite(c.level("temperature")).any() for c in problem.courses):
        yield _warmed(_cycle(0.5 * top, far, 40.0), 15.0)


def _warmed(sweep: Sweep, kelvin: float) -> Sweep:
    """Give the sweep with the muscle warmed up before."""
    title = f"{sweep.title}, with the muscle {kelvin:g} K warmer"
    return sweep._replace(warmer=kelvin, title=title)


def _grid(duration: float) -> Array:
    return np.linspace(0.0, duration, round(duration / SAMPLING) + 1)


def _triangle(time: Array, duration: float) -> Array:
    return 1 - np.abs(2 * time / duration - 1)


def _ramp(kind: Kind, top: float, contraction: float, duration: float) -> Sweep:
    time = _grid(duration)
    place = f"contraction {contraction:.3g}" if contraction else "rest length"
    title = f"pressure up to {top / 1e3:.0f} kPa and back in {duration:g} s at {place}"
    pressure = top * _triangle(time, duration)
    return Sweep(kind, title, time, pressure, np.full_like(time, contraction))


def _cycle(pressure: float, far: float, duration: float) -> Sweep:
    time = _grid(duration)
    title = f"length there and back in {duration:g} s at {pressure / 1e3:.0f} kPa"
    return Sweep(
        Kind.ISOBARIC, title, time, np.full_like(time, pressure),
        far * _triangle(time, duration),
    )  # fmt: skip


def _nested(pressure: float, far: float) -> Sweep:
    time = _grid(60.0)
    corners = np.array([0.0, 1.0, 0.4, 0.8, 0.5, 0.7, 0.0]) * far
    way = np.interp(time, np.linspace(0, 60.0, corners.size), corners)
    title = f"nested length loops in 60 s at {pressure / 1e3:.0f} kPa"
    return Sweep(Kind.CYCLE, title, time, np.full_like(time, pressure), way)


def _step(pressure: float, contraction: float) -> Sweep:
    time = _grid(120.0)
    rise = np.where(time < 5.0, 0.1, 1.0) * pressure
    title = (
        f"step to {pressure / 1e3:.0f} kPa and hold 115 s at contraction"
        f" {contraction:.3g}"
    )
    return Sweep(Kind.STEP, title, time, rise, np.full_like(time, contraction))


def _plan(sweep: Sweep) -> dict[str, object]:
    """Corner points of the sweep, ready to run, in units of a recording."""
    bends = [0]
    for column in (sweep.pressure, sweep.contraction):
        scale = float(np.ptp(column)) or 1.0
        turn = np.abs(np.diff(column, 2)) > 1e-4 * scale
        bends += (np.flatnonzero(turn) + 1).tolist()
    corners = sorted({*bends, sweep.time.size - 1})
    return {
        "title": sweep.title,
        "t_s": [round(float(sweep.time[i]), 3) for i in corners],
        "pressure_kPa": [round(float(sweep.pressure[i]) / 1e3, 2) for i in corners],
        "contraction": [round(float(sweep.contraction[i]), 5) for i in corners],
        "warmer_K": sweep.warmer,
    }
