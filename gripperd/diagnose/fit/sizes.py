"""Sizes from which a fit begins, where small steps of a size lead nowhere."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.model.effect import Effect
from gripperd.model.parameter import parameters

SMALLEST, LARGEST = 0.2, 5.0
"""Sizes that are tried, of the usual. [-]"""
TRIED = 30
"""How many: neighbours differ by an eighth."""


def sized(problem: Problem, point: Point) -> Point:
    """Give each effect that has not been fitted yet the size that explains most.

    Only a threshold that decides what is followed and what is not: by a small step of
    it most readings do not change, and a few leap.

    Parameters
    ----------
    problem
        The recording and the model.
    point
        Where a fit is to start.
    """
    for effect in point.effects:
        for name, known in parameters(effect).items():
            if known.decides and getattr(effect, name) == known.scale:
                # Each in the same turn, the last, so that nothing but the size differs.
                usual = point.with_effect(effect)
                tried = [usual, *_tried(usual, effect, name, known.scale)]
                point = min(tried, key=lambda one: _misfit(problem, one, effect))
    return point


def _tried(point: Point, effect: Effect, name: str, usual: float) -> Iterator[Point]:
    for size in np.geomspace(SMALLEST * usual, LARGEST * usual, TRIED):
        yield point.changed(replace(effect, **{name: float(size)}))


def _misfit(problem: Problem, point: Point, effect: Effect) -> float:
    """Chi² in the signal of an effect. [-]."""
    expected = problem.expected(problem.explanation(point), frozenset({effect.signal}))
    return sum(
        float(np.sum(problem.white([measured - told], index) ** 2))
        for index, (block, measured, told) in enumerate(
            zip(problem.blocks, problem.measured, expected, strict=True)
        )
        if block.signal is effect.signal
    )
