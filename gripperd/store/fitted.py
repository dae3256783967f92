"""Numbers of a fit that a model file has a place for, and how far they may be off."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import sqrt
from typing import NamedTuple

import numpy as np

from gripperd.diagnose.diagnosis import Diagnosis
from gripperd.diagnose.fit.candidates import WRONG
from gripperd.diagnose.residuals.constants import PARTS, Constant
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.verdict.key import Key, keys_of, known_key, public
from gripperd.model.track import Array

WIDTH, ZERO = "gripper.open_width", "zero.opening"
"""No recording tells the width of open jaws from the zero of their sensor, so that the
width is told by the sensor that there is."""


class Number(NamedTuple):
    """One fitted number."""

    path: str
    """As in tolerances, such as ``muscle.diameter`` or ``effects.creep.time``."""
    name: str
    """For others, such as ``parameter:muscle.diameter_mm`` or ``creep.time_s``."""
    key: Key
    row: Array
    """What one unit of each number of the fit adds to it. [SI]"""


@dataclass(frozen=True)
class Fitted:
    """Constants of the model and numbers of what was named, in the fit's order."""

    numbers: tuple[Number, ...]
    covariance: Array
    """Of these, shape ``(n, n)``. [SI]"""

    def std(self, path: str) -> float:
        """Standard deviation of one of them. [SI]."""
        place = [number.path for number in self.numbers].index(path)
        return sqrt(float(self.covariance[place, place]))


def fitted(diagnosis: Diagnosis) -> Fitted:
    """Give what was fitted and has a name for users, with its covariance."""
    numbers = tuple(_numbers(diagnosis))
    if not numbers:
        return Fitted((), np.empty((0, 0)))
    rows = np.array([number.row for number in numbers])
    matrix = rows @ diagnosis.contest.best.fit.posterior @ rows.T
    # Rounding in a product leaves its halves a little apart.
    return Fitted(numbers, (matrix + matrix.T) / 2)


def kept(diagnosis: Diagnosis) -> Point:
    """What was found without what belongs to the rig of the recording."""
    point, moved = diagnosis.explained, diagnosis.found.problem.constants
    shifts = np.where([is_owned(one) for one in moved], point.shifts, 0.0)
    places = {one.path: place for place, one in enumerate(moved)}
    if {WIDTH, ZERO} <= places.keys():
        zero = moved[places[ZERO]].value(point.shifts[places[ZERO]])
        shifts[places[WIDTH]] += zero / moved[places[WIDTH]].sigma
    return replace(point, shifts=shifts)


def constants(diagnosis: Diagnosis) -> Iterator[tuple[Constant, float]]:
    """Give those of the model file, each with its value in the version. [SI]."""
    shifts = kept(diagnosis).shifts.tolist()
    for constant, shift in zip(diagnosis.found.problem.constants, shifts, strict=True):
        if is_owned(constant):
            yield constant, constant.value(shift)


def is_owned(constant: Constant) -> bool:
    """Whether a constant of a fit has a place in a model file."""
    return constant.path.partition(".")[0] in PARTS


def _numbers(diagnosis: Diagnosis) -> Iterator[Number]:
    fit, point = diagnosis.contest.best.fit, diagnosis.explained
    moved = diagnosis.found.problem.constants
    widths = point.widths * [one.sigma for one in moved]
    units = np.diag([*widths.tolist(), *(one.unit for one in fit.coordinates)])
    zero = sum(units[i] for i, one in enumerate(moved) if one.path == ZERO)
    for index, (constant, row) in enumerate(zip(moved, units, strict=False)):
        if is_owned(constant) or index in point.freed:
            path, key = constant.path, known_key(constant.path)
            whole = row + zero if path == WIDTH else row
            yield Number(constant.stated_as, public(f"{WRONG}{path}"), key, whole)
    keys = {one.name: keys_of(one) for one in diagnosis.named if one.effect}
    for one, row in zip(fit.coordinates, units[len(moved) :], strict=True):
        key = keys[one.effect][one.parameter]
        path = f"effects.{one.effect}.{one.parameter}"
        yield Number(path, f"{one.effect}.{key.text}", key, row)
