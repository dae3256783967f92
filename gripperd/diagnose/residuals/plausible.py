"""Units that cannot be: a recording so far off that no physics explains it."""

import numpy as np

from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.errors import InputError
from gripperd.model.effect import Signal
from gripperd.model.track import Array

BELIEVED = (0.27, 3.5)
"""Measured over predicted: real muscles with all their threshold, rubber and bore stay
within a factor of three, the nearest mistaken unit (lbf for N) is off by 4.4. [-]"""
COLUMNS = {Signal.PRESSURE: "pressure_kPa", Signal.FORCE: "force_N"}
"""Along the chain: a pressure in bar makes the force look wrong as well."""
MISTAKEN = {
    Signal.FORCE: {"lbf": 0.2248, "kgf": 0.1020, "kN": 1e-3, "mN": 1e3},
    Signal.PRESSURE: {"bar": 1e-2, "psi": 0.1450, "MPa": 1e-3, "Pa": 1e3},
}


def check_plausible(problem: Problem, name: str) -> None:
    """Refuse a recording that the model cannot be about.

    Raises
    ------
    InputError
        When no stage can be compared, the length is outside what a braid can do, or a
        column is off by the factor of a mistaken unit.
    """
    _check_length(problem, name)
    if not problem.blocks:
        message = (
            f"{name}: no stage of the model can be compared with what was measured;"
            " a run needs current and pressure, or pressure, contraction and force,"
            " or, with a gripper in the model, opening or grip, at 4 samples or more"
        )
        raise InputError(message)
    expected = problem.expected(problem.explanation(_nominal(problem)))
    for signal, column in COLUMNS.items():
        pairs = [
            (y, f)
            for block, y, f in zip(
                problem.blocks, problem.measured, expected, strict=True
            )
            if block.signal is signal
        ]
        if pairs:
            measured, there = map(np.concatenate, zip(*pairs, strict=True))
            _check_unit(signal, f"{name}: column {column}", measured, there)


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


def _check_unit(signal: Signal, place: str, measured: Array, expected: Array) -> None:
    pulling = np.abs(expected) > 0.2 * np.max(np.abs(expected))
    power = float(expected[pulling] @ expected[pulling])
    ratio = float(measured[pulling] @ expected[pulling]) / power if power > 0 else 1.0
    low, high = BELIEVED
    if low < ratio < high:
        return
    units = MISTAKEN[signal]
    near = min(
        units, key=lambda unit: abs(np.log(abs(ratio) + 1e-12) - np.log(units[unit]))
    )
    message = (
        f"{place} is {ratio:.3g} times what the model gives,"
        f" believable is {low:g} to {high:g}; is it in {near}, of another muscle,"
        " or with the wrong sign?"
    )
    raise InputError(message, key=COLUMNS[signal])
