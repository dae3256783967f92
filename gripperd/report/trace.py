"""What was measured in one sweep, and what three models expect of it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from gripperd.diagnose.diagnosis import Diagnosis
from gripperd.diagnose.readings.columns import BY_QUANTITY
from gripperd.diagnose.readings.recording import Kind
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.verdict.initial_state import with_fitted_state
from gripperd.model.effect import Signal
from gripperd.model.track import Array

GAP = 3.5
"""Longest step inside a line, in those of the sampling: three samples are missing."""
REGRESSORS = ("current", "pressure", "contraction", "temperature")


class State(StrEnum):
    """A model that is compared with the measurement."""

    NOMINAL = "as it came"
    RECALIBRATED = "better constants"
    EXPLAINED = "with what was found"
    NEAREST = "with what came nearest"


@dataclass(frozen=True)
class Trace:
    """One signal in one sweep; arrays of one shape ``(n,)``, in the units of files."""

    run: str
    kind: Kind | None
    start: float
    """Of the sweep, since the start of the recording. [s]"""
    time: Array
    """Since the start of the sweep. [s]"""
    measured: Array
    expected: Mapping[State, Array]
    """Nothing but the model itself when nothing was found."""
    levels: Mapping[str, Array]
    """Of those regressors that were measured, by quantity."""
    direction: Array
    """Of travel, 0 in a sweep without. [-1, 1]"""
    held_out: NDArray[np.bool_]
    """Samples that took no part in fitting."""

    def residual(self, state: State) -> Array:
        """Measured minus expected."""
        return self.measured - self.expected[state]


def traces(diagnosis: Diagnosis, signal: Signal) -> tuple[Trace, ...]:
    """Give every sweep that shows a signal, in order of time."""
    whole = replace(diagnosis.split.train, kept=())
    points = {
        State.NOMINAL: diagnosis.nominal,
        State.RECALIBRATED: diagnosis.recalibrated,
    }
    if diagnosis.named:
        established = diagnosis.verdict.establishes
        last = State.EXPLAINED if established else State.NEAREST
        points[last] = diagnosis.explained
    expected = {
        state: whole.expected(
            whole.explanation(with_fitted_state(diagnosis.split, point))
        )
        for state, point in points.items()
    }
    return tuple(
        _trace(
            diagnosis,
            whole,
            index,
            {state: one[index] for state, one in expected.items()},
        )
        for index, block in enumerate(whole.blocks)
        if block.signal is signal
    )


def _trace(
    diagnosis: Diagnosis, whole: Problem, index: int, expected: Mapping[State, Array]
) -> Trace:
    block = whole.blocks[index]
    course, good = whole.courses[block.course], block.good
    column = BY_QUANTITY[block.signal.value]
    levels = {
        name: BY_QUANTITY[name].written(course.level(name)[good])
        for name in REGRESSORS
        if np.isfinite(course.level(name)[good]).all()
    }
    kept = diagnosis.split.test.kept
    return Trace(
        run=course.run,
        kind=course.kind,
        start=float(course.time[0]) - course.start,
        time=course.time[good] - course.time[0],
        measured=column.written(whole.readings[index]),
        expected={state: column.written(values) for state, values in expected.items()},
        levels=levels,
        direction=course.direction[good],
        held_out=kept[block.course][good],
    )


def stretches(time: Array, stride: int = 1) -> list[NDArray[np.intp]]:
    """Every so many rows of each stretch of time in which no sample is missing."""
    rows = np.arange(time.size)
    if rows.size < 2:
        return [rows]
    steps = np.diff(time)
    breaks = np.flatnonzero(steps > GAP * np.median(steps)) + 1
    return [part[::stride] for part in np.split(rows, breaks)]


def broken(values: Array, parts: Sequence[NDArray[np.intp]]) -> Array:
    """Values of some stretches as one line, with NaN where it is broken."""
    return np.concatenate([one for rows in parts for one in (values[rows], [np.nan])])


def elided(name: str, most: int) -> str:
    """Shorten a name to its end, which is where the names of sweeps differ.

    >>> elided("2022-12-07_181607_step_exp", 12)
    '…07_step_exp'
    """
    return name if len(name) <= most else f"…{name[1 - most :]}"


def joined(found: tuple[Trace, ...], state: State) -> Array:
    """Residuals of all sweeps, one after the other."""
    return np.concatenate([one.residual(state) for one in found])


def level(found: tuple[Trace, ...], name: str) -> Array:
    """A regressor over all sweeps, NaN where it was not measured."""
    return np.concatenate(
        [one.levels.get(name, np.full_like(one.time, np.nan)) for one in found]
    )
