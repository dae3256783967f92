"""Columns that cannot be what they are called: they contradict each other."""

import numpy as np

from gripperd.diagnose.readings.columns import BY_QUANTITY
from gripperd.diagnose.readings.course import is_table
from gripperd.diagnose.residuals.problem import Problem
from gripperd.errors import InputError
from gripperd.model.effect import Signal
from gripperd.model.track import Array
from gripperd.units import KILO, MILLI

SCATTER = 0.1
"""Noise over the range of a column, from zero at least, from which it is none: of all
that were measured, tables of a chart apart, 0.03 at most. [-]"""
ALIKE = 0.15
"""Share by which two columns of one thing may differ: more is no calibration. [-]"""
USUAL = 0.99
"""Quantile of a pressure that stands for its highest: some readings overshoot. [-]"""
ATMOSPHERE, NEARLY = 101_325.0, 8e3
"""Standard atmosphere, and by how much that of a day and place below 500 m, or a gauge,
is off. [Pa]"""


def check_coherent(problem: Problem, name: str) -> None:
    """Refuse a recording of which columns contradict themselves or each other.

    Raises
    ------
    InputError
        Readings have nothing to do with their neighbours, a length and a contraction do
        not tell the same, a supply is below what it feeds, or a pressure is absolute.
    """
    _check_scatter(problem, name)
    _check_lengths(problem, name)
    _check_supply(problem, name)
    _check_gauge(problem, name)


def _check_scatter(problem: Problem, name: str) -> None:
    """Refuse readings that have nothing to do with their neighbours."""
    if is_table(problem.courses):
        return
    for signal in (Signal.FORCE, Signal.PRESSURE):
        seen = _read(problem, signal.value)
        noise = problem.noises.get(signal)
        spread = float(np.ptp(seen)) if seen.size else 0.0
        # What is held at one value throughout has no other range than its noise.
        reach = max(spread, float(np.max(np.abs(seen), initial=0.0)))
        if noise is None or not spread or noise.std <= SCATTER * reach:
            continue
        column = BY_QUANTITY[signal.value]
        message = (
            f"{name}: column {column.name} scatters by {column.shown(noise.std)} from"
            f" one reading to the next, of {column.shown(spread)} in all;"
            " no sensor does: are its rows in the order of time?"
        )
        raise InputError(message, key=column.name)


def _check_lengths(problem: Problem, name: str) -> None:
    """Refuse a length and a contraction that do not tell the same."""
    both = [
        (one.column("length"), one.column("contraction"))
        for one in problem.courses
        if {"length", "contraction"} <= one.measured.keys()
    ]
    if not both:
        return
    length, contraction = (
        np.concatenate(columns) for columns in zip(*both, strict=True)
    )
    known = np.isfinite(length) & np.isfinite(contraction)
    way, told = length[known], contraction[known]
    if way.size < 2 or not np.ptp(way):
        return
    rest = problem.model.muscle.rest_length
    ratio = -float(np.polyfit(way, told, 1)[0]) * rest
    if abs(ratio - 1) > ALIKE:
        message = (
            f"{name}: columns contraction and length_mm contradict each other: of a"
            f" muscle of {rest / MILLI:g} mm the former goes {ratio:.3g} times as far"
            " as the latter; leave out the wrong one"
        )
        raise InputError(message, key="length_mm")


def _check_supply(problem: Problem, name: str) -> None:
    supply, pressure = _read(problem, "supply"), _read(problem, "pressure")
    if not (supply.size and pressure.size):
        return
    fed, there = float(np.max(supply)), float(np.quantile(pressure, USUAL))
    if fed < there * (1 - ALIKE):
        message = (
            f"{name}: column supply_kPa is {fed / KILO:.4g} kPa at most, and the muscle"
            f" has {there / KILO:.4g} kPa; is the supply in bar, or before a booster?"
        )
        raise InputError(message, key="supply_kPa")


def _check_gauge(problem: Problem, name: str) -> None:
    """Refuse a pressure that has the atmosphere in it throughout."""
    regulator = problem.model.regulator
    current, pressure = _read(problem, "current"), _read(problem, "pressure")
    if regulator is None or not (current.size and pressure.size):
        return
    asked = max(float(np.min(regulator.pressure(current))), regulator.pressure_low)
    lowest = float(np.quantile(pressure, 1 - USUAL))
    if abs(lowest - asked - ATMOSPHERE) < NEARLY and asked < ATMOSPHERE / 4:
        message = (
            f"{name}: column pressure_kPa is never below {lowest / KILO:.4g} kPa, where"
            f" {asked / KILO:.4g} kPa are asked for; is it absolute? Take off the"
            " pressure of the air"
        )
        raise InputError(message, key="pressure_kPa")


def _read(problem: Problem, name: str) -> Array:
    """All known readings of a column. [SI]."""
    column = np.concatenate([one.column(name) for one in problem.courses])
    known: Array = column[np.isfinite(column)]
    return known
