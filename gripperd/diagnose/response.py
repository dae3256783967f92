"""How a recording would change with every constant and every effect."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

from gripperd.diagnose.explanation import Explanation
from gripperd.diagnose.point import Point
from gripperd.diagnose.problem import Problem
from gripperd.diagnose.runs import Runs
from gripperd.model.effect import Effect, Signal, Stage, acts_in_gripper
from gripperd.model.parameter import parameters
from gripperd.model.track import Array

STEP = 0.25
"""Step of a difference quotient, in sigma of a constant or scales of an amplitude."""


def sensitivities(problem: Problem, point: Point) -> list[list[Array]]:
    """Change of every block for one sigma of each constant; constants first."""
    base = problem.expected(problem.explanation(point))
    # Constants of one sweep each are moved together: none feels the others.
    own = [i for i, one in enumerate(problem.constants) if one.course is not None]
    apart = _slope(problem, point, own, base) if own else []
    found: list[list[Array]] = []
    for index, constant in enumerate(problem.constants):
        if constant.course is None:
            found.append(_slope(problem, point, [index], base))
        else:
            found.append(_of_course(problem, apart, constant.course))
    return found


def _slope(
    problem: Problem, point: Point, indices: list[int], base: list[Array]
) -> list[Array]:
    shifts = point.shifts.copy()
    shifts[indices] += STEP
    there = problem.explanation(replace(point, shifts=shifts))
    moved_on = frozenset[Signal]().union(*(problem.constants[i].moves for i in indices))
    return _quotient(problem, problem.expected(there, moved_on), base, STEP)


def _of_course(problem: Problem, columns: list[Array], course: int) -> list[Array]:
    return [
        column if block.course == course else zero
        for column, block, zero in zip(
            columns, problem.blocks, problem.zeros, strict=True
        )
    ]


def responses(problem: Problem, point: Point, effect: Effect) -> list[list[Array]]:
    """Change of every block for one scale of each amplitude of an effect.

    For an effect that already acts at the point, the slope there; for a new one
    its response at one scale, so that an effect with a threshold is seen.
    """
    here = problem.explanation(point)
    acts = any(one.name == effect.name for one in point.effects)
    base = problem.explanation(point.without(effect.name)) if not acts else here
    tracks = problem.tracks(base)
    start = problem.expected(base, None, tracks)
    return [
        change(problem, base.with_effect(one), start, one, tracks, size)
        for one, size in _nudged(effect, acts=acts)
    ]


def change(
    problem: Problem,
    there: Explanation,
    here: list[Array],
    effect: Effect,
    tracks: Sequence[Runs],
    step: float,
) -> list[Array]:
    """Difference quotient of every block when one effect changes.

    Parameters
    ----------
    there, here
        The explanation with the change, and what is expected without.
    effect
        What changed.
    tracks
        What happened, without the change.
    step
        Its size.
    """
    # A sensor changes what is thought to have happened; nothing else does.
    known = None if effect.stage is Stage.SENSOR else tracks
    expected = problem.expected(there, moves(effect), known)
    return _quotient(problem, expected, here, step)


def _quotient(
    problem: Problem, there: list[Array], here: list[Array], step: float
) -> list[Array]:
    """Difference quotient block by block; 0 where nothing was asked."""
    return [
        (a - b) / step if a.size else zero
        for a, b, zero in zip(there, here, problem.zeros, strict=True)
    ]


def moves(effect: Effect) -> frozenset[Signal] | None:
    """Signals an effect changes; all for a sensor."""
    if effect.stage is Stage.SENSOR:
        return None
    stretches = acts_in_gripper(effect) and effect.hidden_contraction(1.0) != 0
    return frozenset({effect.signal, Signal.FORCE} if stretches else {effect.signal})


def _nudged(effect: Effect, *, acts: bool) -> Iterator[tuple[Effect, float]]:
    """Give the effect with one amplitude moved at a time, and by how many scales."""
    known = parameters(effect)
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
