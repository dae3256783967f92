"""Units that cannot be: a recording so far off that no physics explains it."""

import numpy as np

from gripperd.diagnose.readings.columns import BY_QUANTITY
from gripperd.diagnose.residuals.holdout import Split
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.errors import InputError
from gripperd.model.effect import Signal
from gripperd.model.track import Array

BELIEVED = (0.27, 3.5)
"""Measured over predicted: real muscles with all their threshold, rubber and bore stay
within a factor of three, the nearest mistaken unit (lbf for N) is off by 4.4. [-]"""
NEAR = 1.5
"""Factor within which a column is off by that of a unit. [-]"""
FORCES = {"lbf": 0.2248, "kgf": 0.1020, "kN": 1e-3, "mN": 1e3}
MISTAKEN = {
    Signal.PRESSURE: {"bar": 1e-2, "psi": 0.1450, "MPa": 1e-3, "Pa": 1e3},
    Signal.FORCE: FORCES,
    Signal.GRIP: FORCES,
}
"""Along the chain: a pressure in bar makes the force look wrong as well."""


def check_plausible(problem: Problem, name: str) -> None:
    """Refuse a recording that the model cannot be about.

    Raises
    ------
    InputError
        When no stage can be compared, the length is outside what a braid can do, a
        sensor shows nothing, or a column is off by the factor of a mistaken unit.
    """
    _check_length(problem, name)
    if not problem.blocks:
        message = (
            f"{name}: no stage of the model can be compared with what was measured;"
            " a run needs, in 4 samples or more that lie beside no step, current and"
            " pressure; or pressure, contraction and force"
        )
        if problem.model.linkage is None:
            message += (
                "; the model has no gripper, so that opening and grip say nothing"
            )
        else:
            message += (
                "; or contraction and opening; or contraction, grip, and force or"
                " pressure; where no contraction was measured the opening tells it"
            )
        raise InputError(message)
    expected = problem.expected(problem.explanation(_nominal(problem)))
    _check_alive(problem, name)
    for signal in MISTAKEN:
        pairs = [
            (y, f)
            for block, y, f in zip(
                problem.blocks, problem.measured, expected, strict=True
            )
            if block.signal is signal
        ]
        if pairs:
            measured, there = map(np.concatenate, zip(*pairs, strict=True))
            _check_unit(signal, name, measured, there)


def _nominal(problem: Problem) -> Point:
    return Point(np.zeros(len(problem.constants)))


def _check_length(problem: Problem, name: str) -> None:
    straight = problem.model.muscle.straight
    for course in problem.courses:
        length = course.level("contraction")
        seen = length[np.isfinite(length)]
        if seen.size and (seen.min() <= straight or seen.max() >= 0.6):
            message = (
                f"{name}: run {course.run}: contraction {seen.min():.3g} to"
                f" {seen.max():.3g} is outside what the braid of the model can do,"
                f" {straight:.3f} to 0.6; is it a ratio, counted from the rest length?"
            )
            raise InputError(message, key="contraction")


def _check_alive(problem: Problem, name: str) -> None:
    names = {key for course in problem.courses for key in course.measured} - {"time"}
    columns = [
        np.concatenate([c.column(key) for c in problem.courses]) for key in names
    ]
    seen = [column[np.isfinite(column)] for column in columns]
    if not any(column.size and np.ptp(column) for column in seen):
        message = f"{name}: nothing varies: every column keeps its first value"
        raise InputError(message)
    for signal, top in problem.full_scale.items():
        if top == 0:
            column = BY_QUANTITY[signal.value].name
            message = f"{name}: column {column} is 0 throughout; is the sensor on?"
            raise InputError(message, key=column)


def _check_unit(signal: Signal, name: str, measured: Array, expected: Array) -> None:
    pulling = np.abs(expected) > 0.2 * np.max(np.abs(expected))
    power = float(expected[pulling] @ expected[pulling])
    ratio = float(measured[pulling] @ expected[pulling]) / power if power > 0 else 1.0
    low, high = BELIEVED
    if low < ratio < high:
        return
    column = BY_QUANTITY[signal.value].name
    causes = [
        f"in {unit}"
        for unit, factor in MISTAKEN[signal].items()
        if factor / NEAR < abs(ratio) < factor * NEAR
    ]
    if ratio < 0:
        causes.insert(0, "with the wrong sign")
    causes.append(f"of another {'gripper' if signal is Signal.GRIP else 'muscle'}")
    message = (
        f"{name}: column {column} is {ratio:.3g} times what the model gives,"
        f" believable is {low:g} to {high:g}; is it {', or '.join(causes)}?"
    )
    raise InputError(message, key=column)


def check_judged(parts: Split, name: str) -> None:
    """Refuse a recording of which nothing can be left out to judge by.

    Raises
    ------
    InputError
        When no sample can be compared in one of its two parts.
    """
    if not (parts.train.blocks and parts.test.blocks):
        message = (
            f"{name}: too few samples can be compared to leave some out and judge by"
            " them; record more sweeps, or more samples of each"
        )
        raise InputError(message)
