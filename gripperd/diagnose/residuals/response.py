"""How a recording would change with every constant and every effect."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from gripperd.diagnose.residuals.explanation import Explanation, moves
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.residuals.runs import Runs
from gripperd.model.effect import Effect, Signal, Stage
from gripperd.model.parameter import in_use
from gripperd.model.track import Array

STEP = 0.25
"""Step of a difference quotient, in sigma of a constant or scales of an amplitude."""
_NOTHING: Array = np.empty(0)


@dataclass(frozen=True)
class Base:
    """What is expected at a point, from which changes are counted."""

    explanation: Explanation
    tracks: tuple[Runs, ...]
    expected: list[Array]

    @classmethod
    def of(cls, problem: Problem, point: Point) -> "Base":
        """Evaluate a problem at a point."""
        explanation = problem.explanation(point)
        tracks = problem.tracks(explanation)
        return cls(explanation, tracks, problem.expected(explanation, tracks=tracks))


def sensitivities(
    problem: Problem, point: Point, base: Base | None = None
) -> list[list[Array]]:
    """Change of every block for one sigma of each constant; constants first."""
    base = base or Base.of(problem, point)
    here = base.expected
    # At its upper end a constant moves back: a sign of friction is 1 there for good.
    _, ends = problem.ends(point)
    steps = np.where(point.shifts + STEP > ends * point.widths, -STEP, STEP)
    # Constants of one sweep each are moved together: none feels the others.
    own = [i for i, one in enumerate(problem.constants) if one.course is not None]
    apart = _moved(problem, point, base, own, steps) if own else []
    found: list[list[Array]] = []
    for index, constant in enumerate(problem.constants):
        if constant.course is None:
            there = _moved(problem, point, base, [index], steps)
        else:
            there = _of_course(problem, apart, constant.course)
        found.append(_quotient(problem, there, here, float(steps[index])))
    return found


def _moved(
    problem: Problem, point: Point, base: Base, indices: list[int], steps: Array
) -> list[Array]:
    """Readings where some constants are moved on; empty where they change nothing."""
    shifts = point.shifts.copy()
    shifts[indices] += steps[indices]
    there = problem.explanation(replace(point, shifts=shifts))
    moving = [problem.constants[i] for i in indices]
    signals = frozenset[Signal]().union(*(one.moves for one in moving))
    told = problem.model.told_by is not None
    tracks = None if told or any(one.reads for one in moving) else base.tracks
    return problem.expected(there, signals, tracks)


def _of_course(problem: Problem, readings: list[Array], course: int) -> list[Array]:
    return [
        reading if block.course == course else _NOTHING
        for reading, block in zip(readings, problem.blocks, strict=True)
    ]


def responses(
    problem: Problem, point: Point, effect: Effect, base: Base | None = None
) -> list[list[Array]]:
    """Change of every block for one scale of each amplitude in use of an effect.

    For an effect that already acts at the point, the slope there; for a new one
    its response at one scale, so that an effect with a threshold is seen.
    """
    base = base or Base.of(problem, point)
    acts = any(one.name == effect.name for one in point.effects)
    return [
        change(problem, base, base.explanation.with_effect(one), one, size)
        for one, size in _nudged(effect, acts=acts)
    ]


def change(
    problem: Problem,
    base: Base,
    there: Explanation,
    effect: Effect,
    step: float,
) -> list[Array]:
    """Difference quotient of every block when one effect changes.

    Parameters
    ----------
    base
        Without the change.
    there
        The explanation with it.
    effect
        What changed.
    step
        Its size.
    """
    # A sensor changes what is thought to have happened, and jaws that tell the length.
    told = effect.stage is Stage.GRIPPER and problem.model.told_by is not None
    known = None if told or effect.stage is Stage.SENSOR else base.tracks
    expected = problem.expected(there, moves(effect), known)
    return _quotient(problem, expected, base.expected, step)


def _quotient(
    problem: Problem, there: list[Array], here: list[Array], step: float
) -> list[Array]:
    """Difference quotient block by block; 0 where nothing was asked."""
    return [
        (a - b) / step if a.size else zero
        for a, b, zero in zip(there, here, problem.zeros, strict=True)
    ]


def _nudged(effect: Effect, *, acts: bool) -> Iterator[tuple[Effect, float]]:
    """Give the effect with one amplitude moved at a time, and by how many scales."""
    known = in_use(effect, effect.idle)
    amplitudes = [name for name, one in known.items() if one.is_amplitude]
    if not amplitudes and not acts:
        yield effect, 1.0
    for name in amplitudes:
        scale = known[name].scale
        if acts:
            value = getattr(effect, name) + STEP * scale
            yield replace(effect, **{name: value}), STEP
        else:
            silent = dict.fromkeys(amplitudes, 0.0)
            yield replace(effect, **(silent | {name: scale})), 1.0
