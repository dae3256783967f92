"""Initial state of sweeps that were left out: the sign of friction they rest with.

It is as unknown as in the others, and nothing but their own samples can tell it.

References
----------
.. [1] MathWorks, "System Identification Toolbox", ``compare`` and ``findstates``: so is
       the initial state of the data that a model is compared with.
"""

from dataclasses import replace

import numpy as np

from gripperd.diagnose.residuals.constants import SHARED, together
from gripperd.diagnose.residuals.holdout import Split
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem

TRIED = np.linspace(-1.0, 1.0, 401)
"""Signs among which the likeliest is taken. [-]"""


def with_fitted_state(parts: Split, point: Point) -> Point:
    """Give each sweep that was left out the sign of friction that it rests with.

    One number for each, and the only one that is fitted to them: about the usual sign
    of those that were not left out, and with the prior that they had. Friction is
    taken to be proportional to it, so that the misfit is a parabola.

    Parameters
    ----------
    parts
        What was searched, and what was left out.
    point
        Fitted to the former.
    """
    test, own = parts.test, _own(parts)
    point = with_usual_state(parts.train, point)
    if not own:
        return point
    usual = point.shifts
    (shared,) = (
        float(shift) * constant.sigma
        for shift, constant in zip(usual, test.constants, strict=True)
        if constant.path == SHARED
    )

    def with_all(sign: float) -> Point:
        shifts = usual.copy()
        for place in own.values():
            shifts[place] = together(sign, -shared) / test.constants[place].sigma
        return replace(point, shifts=shifts)

    back, none, there = (_misfits(test, with_all(sign)) for sign in (-1.0, 0.0, 1.0))
    shifts = usual.copy()
    for course, place in own.items():
        slope = 0.5 * (there[course] - back[course])
        bend = 0.5 * (there[course] + back[course]) - none[course]
        alone = together(TRIED, -shared) / test.constants[place].sigma
        price = slope * TRIED + bend * TRIED**2 + (alone - usual[place]) ** 2
        shifts[place] = alone[np.argmin(price)]
    return replace(point, shifts=shifts)


def _own(parts: Split) -> dict[int, int]:
    """Places of the signs that only sweeps left out can tell, by sweep."""
    judged = {block.course for block in parts.test.blocks}
    judged -= {block.course for block in parts.train.blocks}
    return {
        constant.course: place
        for place, constant in enumerate(parts.test.constants)
        if constant.course in judged and constant.course is not None
    }


def _misfits(problem: Problem, point: Point) -> dict[int, float]:
    """Squares of what is left of each sweep, of its noise: as a gap has it. [-]."""
    found: dict[int, float] = {}
    residuals = problem.residuals(point)
    for block, residual in zip(problem.blocks, residuals, strict=True):
        squares = np.sum((residual / problem.floor(block.signal)) ** 2)
        found[block.course] = found.get(block.course, 0.0) + float(squares)
    return found


def with_usual_state(train: Problem, point: Point) -> Point:
    """Give sweeps that were left out the usual sign of friction of those that were not.

    Those that never move are set up alike, and so are those that move off from rest;
    few that came the other way change nothing (median).

    Parameters
    ----------
    train
        What was searched.
    point
        Fitted to it.
    """
    fitted = {block.course for block in train.blocks}
    signs = train.explanation(point).rests
    known = {course: sign for course, sign in signs.items() if course in fitted}
    moves = [bool(course.direction.any()) for course in train.courses]
    shifts = point.shifts.copy()
    for index, constant in enumerate(train.constants):
        own = constant.course
        if own is None or own in fitted:
            continue
        alike = [sign for course, sign in known.items() if moves[course] == moves[own]]
        usual = float(np.median(alike or [*known.values()] or [0.0]))
        # Of its own nothing was fitted: what it has is what all share.
        shifts[index] = together(usual, -signs[own]) / constant.sigma
    return replace(point, shifts=shifts)
