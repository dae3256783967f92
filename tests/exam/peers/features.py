"""What a correction without physics may look at, signal by signal."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from gripperd.diagnose.readings.course import Course
from gripperd.diagnose.residuals.problem import Problem
from gripperd.model.track import Array
from tests.exam.peers.exhibit import Exhibit

VARIABLES: Mapping[str, tuple[str, ...]] = {
    "pressure": ("current", "direction", "still", "supply", "time"),
    "force": ("pressure", "contraction", "direction", "temperature", "time"),
    "opening": ("contraction", "force", "direction", "time"),
    "grip": ("force", "contraction", "direction", "time"),
}
"""Regressors of the residual of each signal."""


@dataclass(frozen=True)
class Sheet:
    """Regressors and residual of one signal, standardised as on the training sweeps."""

    variables: tuple[str, ...]
    inputs: Array
    """Shape ``(n, k)``."""
    residual: Array
    """Shape ``(n,)``. [SI]"""
    course: Array
    """Index of the sweep of each sample."""


def sheets(exhibit: Exhibit) -> Iterator[tuple[str, Sheet, Sheet]]:
    """Yield signal, training and test sheet, for each signal that has both."""
    for signal in exhibit.train.signals:
        if signal not in exhibit.test.signals:
            continue
        train = _sheet(exhibit.train, exhibit, str(signal))
        test = _sheet(exhibit.test, exhibit, str(signal))
        middle, spread = train.inputs.mean(0), train.inputs.std(0)
        spread = np.where(spread > 0, spread, 1.0)
        yield str(signal), _scaled(train, middle, spread), _scaled(test, middle, spread)


def _sheet(problem: Problem, exhibit: Exhibit, signal: str) -> Sheet:
    variables = VARIABLES[signal]
    inputs, residuals, courses = [], [], []
    for block, residual in zip(
        problem.blocks, problem.residuals(exhibit.point), strict=True
    ):
        if block.signal != signal:
            continue
        course = problem.courses[block.course]
        table = [_variable(course, name)[block.good] for name in variables]
        inputs.append(np.column_stack(table))
        residuals.append(residual)
        courses.append(np.full(residual.size, float(block.course)))
    # What was not measured is taken for constant.
    table_of_all = np.nan_to_num(np.concatenate(inputs))
    return Sheet(
        variables, table_of_all, np.concatenate(residuals), np.concatenate(courses)
    )


def _variable(course: Course, name: str) -> Array:
    if name == "direction":
        return _direction(course)
    if name in ("time", "still"):
        return course.time if name == "time" else course.still
    return course.level(name)


def _direction(course: Course) -> Array:
    """Direction of travel; of the pressure where nothing travels. [-]."""
    if course.direction.any() or "pressure" not in course.smooth:
        return np.asarray(course.direction, np.float64)
    return np.sign(course.smooth["pressure"].rate)


def _scaled(sheet: Sheet, middle: Array, spread: Array) -> Sheet:
    inputs = (sheet.inputs - middle) / spread
    return Sheet(sheet.variables, inputs, sheet.residual, sheet.course)
