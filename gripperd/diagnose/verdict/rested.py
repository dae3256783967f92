"""How the rig came to rest in sweeps that were left out.

It is as unknown as in the others, and nothing but their own samples can tell it.

References
----------
.. [1] L. Ljung, "System Identification: Theory for the User", 2nd ed., Prentice Hall,
       1999, section 16.4: the initial state of validation data is estimated from them.
"""

from dataclasses import replace

import numpy as np

from gripperd.diagnose.residuals.constants import together
from gripperd.diagnose.residuals.holdout import Split
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.model.track import Array

STEP = 0.25
"""Change of a sign by which its effect is told, in its prior sigma."""
ROUNDS = 2
"""Signs add up like velocities: nearly straight."""


def with_own_sign(parts: Split, point: Point) -> Point:
    """Give each sweep that was left out the sign of friction that it rests with.

    One number for each, and the only one that is fitted to them: about the usual sign
    of those that were not left out, and with the prior that they had.
    """
    test, own = parts.test, _own(parts)
    point = with_usual_sign(parts.train, point)
    usual = point.shifts
    for _ in range(ROUNDS if own else 0):
        shifts, step = point.shifts.copy(), np.zeros_like(usual)
        for index in own:
            # Inwards: beyond a full sign nothing changes.
            step[index] = -STEP if shifts[index] > 0 else STEP
        there = _white(test, replace(point, shifts=shifts + step))
        here = _white(test, point)
        for index, blocks in own.items():
            left = np.concatenate([here[i] for i in blocks])
            slope = (np.concatenate([there[i] for i in blocks]) - left) / step[index]
            pull = shifts[index] - usual[index] + slope @ left
            full = 1 / test.constants[index].sigma
            found = shifts[index] - pull / (1 + slope @ slope)
            shifts[index] = np.clip(found, -full, full)
        point = replace(point, shifts=shifts)
    return point


def _own(parts: Split) -> dict[int, list[int]]:
    """Place of each sign that only sweeps left out can tell, and their blocks."""
    fitted = {block.course for block in parts.train.blocks}
    found: dict[int, list[int]] = {}
    for index, constant in enumerate(parts.test.constants):
        if constant.course is not None and constant.course not in fitted:
            found[index] = [
                i
                for i, block in enumerate(parts.test.blocks)
                if block.course == constant.course
            ]
    return {index: blocks for index, blocks in found.items() if blocks}


def _white(problem: Problem, point: Point) -> list[Array]:
    residuals = problem.residuals(point)
    return [
        problem.white([residual], index)[:, 0]
        for index, residual in enumerate(residuals)
    ]


def with_usual_sign(train: Problem, point: Point) -> Point:
    """Give sweeps that were left out the usual sign of friction of those that were not.

    Those that never move are set up alike, and so are those that move off from rest;
    few that came the other way change nothing (median).
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
