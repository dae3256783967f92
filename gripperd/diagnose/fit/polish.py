"""The best constants, amplitudes and shapes of one explanation.

References
----------
.. [1] J. Nocedal, S. J. Wright, "Numerical Optimization", 2nd ed., Springer, 2006,
       algorithm 4.1: a step that keeps less than a quarter leads too far.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import inf
from typing import NamedTuple

import numpy as np

from gripperd.diagnose.fit.design import limits, problem_prior
from gripperd.diagnose.fit.quadratic import Quadratic
from gripperd.diagnose.fit.sizes import sized
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.residuals.response import Base, change, responses, sensitivities
from gripperd.model.effect import Effect, Signal
from gripperd.model.parameter import in_use
from gripperd.model.track import Array

ROUNDS = 40
"""At most: a valley that bends takes many."""
TRIALS = 7
"""Steps that are tried in a round, each damped ten times as much as the one before."""
DAMPED = 0.001
"""First damping after a step that did not help, of the diagonal: ten times as much
leaves nothing of the way along a narrow valley. [-]"""
RELATIVE = 5e-5
"""Fall of the cost, of itself, below which another round is not worth it: half a nat
of 20 000 samples. [-]"""
CONVERGED = 0.3
"""Fall of the cost, promised and kept, below which another round is not worth it."""
LEAST_KEPT = 0.25
"""Share of a promised fall of the cost below which a step led too far [1]_. [-]"""
LEAST_ON = 0.01
"""Least of a shape whose 0 is another law, of its largest. [-]"""
SIZE_STEPS = (0.1, 0.02)
"""Longest and least step of a difference quotient, of an amplitude, in widths of its
prior; half as long each round. A dead band goes by jumps, which a long step leads past;
a delay bends at every sample, and needs the slope before the next. [-]"""
SHAPE_STEP = 0.04
"""The same of a shape, in its own size; of one that is 0, a fifth of that, of
its upper bound. [-]"""


class Coordinate(NamedTuple):
    """One number of an effect that is fitted."""

    effect: str
    parameter: str
    unit: float
    """One prior sigma. [SI]"""
    low: float
    high: float
    is_amplitude: bool


@dataclass(frozen=True)
class Polished:
    """A point that cannot be bettered by a small step."""

    point: Point
    cost: float
    """Misfit plus prior: chi² at the point. [-]"""
    misfits: Mapping[Signal, float]
    """Chi² by signal."""
    counts: Mapping[Signal, int]
    """Samples by signal."""
    coordinates: tuple[Coordinate, ...]
    covariance: Array
    """Of constants (in sigma) and coordinates (in units), each shape held about where
    it ended by a prior of half its value, shape ``(k, k)``."""
    information: Array
    """What data alone tell of the same (Fisher), shape ``(k, k)``."""

    @property
    def posterior(self) -> Array:
        """Covariance of the same as data and tolerances alone leave them.

        Of a shape nothing is known before but its limits: it is anywhere between.
        """
        scale = np.ones(len(self.information))
        first = scale.size - len(self.coordinates)
        for place, one in enumerate(self.coordinates, first):
            if not one.is_amplitude:
                scale[place] = (one.high - one.low) / 12**0.5 / one.unit
        known = np.outer(scale, scale) * self.information + np.eye(scale.size)
        return np.asarray(np.outer(scale, scale) * np.linalg.inv(known), np.float64)

    @property
    def samples(self) -> int:
        """Those explained, of all signals."""
        return sum(self.counts.values())


class _Tried(NamedTuple):
    """A point, and what it leaves."""

    point: Point
    base: Base
    cost: float
    white: list[Array]


def polished(
    problem: Problem, point: Point, rounds: int = ROUNDS, enough: float = -inf
) -> Polished:
    """Fit everything at once, from a point nearby.

    Parameters
    ----------
    problem
        The recording and the model.
    point
        Where to start; its effects stay, their numbers move.
    rounds
        At most; one tells by how much it may be bettered, roughly.
    enough
        Cost below which it is not asked how much lower it may be. [-]
    """
    point = sized(problem, point)
    base = Base.of(problem, point)
    coordinates = _coordinates(problem, point, base)
    low, high = bounds(problem, point, coordinates)
    best = _tried(problem, point, coordinates, base)
    information = np.empty((0, 0))
    damping = promised = 0.0
    for turn in range(rounds):
        columns = slopes(problem, best.point, coordinates, best.base, _nearer(turn))
        information = columns.T @ columns
        here = coefficients(best.point, coordinates)
        pull = columns.T @ np.concatenate(best.white) - _priors(here, coordinates)
        model = Quadratic(here, information + np.eye(here.size), pull)
        start = best.cost
        little = max(CONVERGED, RELATIVE * start)
        for _ in range(TRIALS):
            aim = model.lowest(damping, low, high)
            moved = _moved(problem, best.point, coordinates, aim)
            there = _tried(problem, moved, coordinates)
            promised = model.fall(aim)
            kept = start - there.cost > LEAST_KEPT * promised
            eased = damping / 10 if damping > DAMPED else 0.0
            damping = eased if kept else max(10 * damping, DAMPED)
            if there.cost < start or promised < little:
                best = min(best, there, key=lambda one: one.cost)
                break
        fell = start - best.cost
        if fell == 0 or max(fell, promised) < little or best.cost < enough:
            break
    misfits, counts = _by_signal(problem, best.white)
    held = np.asarray(np.linalg.inv(information + np.eye(len(information))), np.float64)
    return Polished(
        best.point, best.cost, misfits, counts, coordinates, held, information
    )


def _by_signal(
    problem: Problem, white: Sequence[Array]
) -> tuple[dict[Signal, float], dict[Signal, int]]:
    """Chi² and samples of each signal."""
    misfits = dict.fromkeys(problem.signals, 0.0)
    counts = dict.fromkeys(problem.signals, 0)
    for block, left in zip(problem.blocks, white, strict=True):
        misfits[block.signal] += float(left @ left)
        counts[block.signal] += left.size
    return misfits, counts


def bounds(
    problem: Problem, point: Point, coordinates: Sequence[Coordinate]
) -> tuple[Array, Array]:
    """Least and largest of constants, in widths, and coordinates, in units."""
    low, high = problem.ends(point)
    lows = np.array([c.low / c.unit for c in coordinates])
    highs = np.array([c.high / c.unit for c in coordinates])
    return np.concatenate([low, lows]), np.concatenate([high, highs])


def _coordinates(problem: Problem, point: Point, base: Base) -> tuple[Coordinate, ...]:
    found: list[Coordinate] = []
    for effect in point.effects:
        answers = iter(responses(problem, point, effect, base))
        for name, known in in_use(effect, effect.idle).items():
            low, high = limits(problem, effect, name)
            if known.is_amplitude:
                prior = problem_prior(problem, effect, next(answers)) or 1.0
                unit = prior * known.scale
            elif known.bends_from(getattr(effect, name)):
                unit = 0.5 * abs(getattr(effect, name)) or 0.1 * known.high
                low = LEAST_ON * known.high if known.switches else low
            else:
                continue
            found.append(
                Coordinate(effect.name, name, unit, low, high, known.is_amplitude)
            )
    return tuple(found)


def coefficients(point: Point, coordinates: Sequence[Coordinate]) -> Array:
    """Where a point stands: constants in widths, coordinates in units."""
    acting = {effect.name: effect for effect in point.effects}
    values = [getattr(acting[c.effect], c.parameter) / c.unit for c in coordinates]
    return np.concatenate([point.shifts / point.widths, np.array(values)])


def _moved(
    problem: Problem, point: Point, coordinates: Sequence[Coordinate], vector: Array
) -> Point:
    count = point.shifts.size
    acting: dict[str, Effect] = {effect.name: effect for effect in point.effects}
    for coordinate, value in zip(coordinates, vector[count:].tolist(), strict=True):
        bounded = min(max(value * coordinate.unit, coordinate.low), coordinate.high)
        effect = acting[coordinate.effect]
        acting[coordinate.effect] = replace(effect, **{coordinate.parameter: bounded})
    shifts = np.clip(vector[:count], *problem.ends(point)) * point.widths
    return replace(point, shifts=shifts, effects=tuple(acting.values()))


def _priors(vector: Array, coordinates: Sequence[Coordinate]) -> Array:
    """Pull of the priors; a shape is held where it is, by a prior of its own size."""
    pull = vector.copy()
    for index, coordinate in enumerate(reversed(coordinates)):
        if not coordinate.is_amplitude:
            pull[-1 - index] = 0.0
    return pull


def _tried(
    problem: Problem,
    point: Point,
    coordinates: Sequence[Coordinate],
    base: Base | None = None,
) -> _Tried:
    base = base or Base.of(problem, point)
    both = zip(problem.measured, base.expected, strict=True)
    white = [problem.white([y - f], index)[:, 0] for index, (y, f) in enumerate(both)]
    pull = _priors(coefficients(point, coordinates), coordinates)
    return _Tried(point, base, float(sum(w @ w for w in white) + pull @ pull), white)


def slopes(
    problem: Problem,
    point: Point,
    coordinates: Sequence[Coordinate],
    base: Base | None = None,
    size_step: float = SIZE_STEPS[0],
) -> Array:
    """Whitened change of every prediction for one unit of each parameter, (n, k)."""
    base = base or Base.of(problem, point)
    columns = sensitivities(problem, point, base)
    here = coefficients(point, coordinates)
    count = point.shifts.size
    for index, coordinate in enumerate(coordinates):
        step = _step(coordinate, here[count + index], size_step)
        vector = here.copy()
        vector[count + index] += step
        moved = _moved(problem, point, coordinates, vector)
        # What is 0 so far changes nothing elsewhere, but may once it has moved.
        effect = next(e for e in moved.effects if e.name == coordinate.effect)
        there = problem.explanation(moved)
        columns.append(change(problem, base, there, effect, step))
    units = [*point.widths.tolist(), *(1.0 for _ in coordinates)]
    return np.concatenate(
        [_slopes(problem, columns, units, index) for index in range(len(problem.zeros))]
    )


def _nearer(turn: int) -> float:
    """Step for sizes in one of the rounds, counted from 0. [-]."""
    longest, least = SIZE_STEPS
    return max(longest * 0.5**turn, least)


def _step(coordinate: Coordinate, here: float, size_step: float) -> float:
    """Of a difference quotient, in units; both its ends lie within the limits."""
    room = (coordinate.high - coordinate.low) / coordinate.unit
    step = min(size_step if coordinate.is_amplitude else 2 * SHAPE_STEP, room / 2)
    return -step if (here + step) * coordinate.unit > coordinate.high else step


def _slopes(
    problem: Problem,
    columns: Sequence[Sequence[Array]],
    units: Sequence[float],
    index: int,
) -> Array:
    """Those of one block; most numbers of one sweep each change nothing in it."""
    zero = problem.zeros[index]
    shown = [place for place, column in enumerate(columns) if column[index] is not zero]
    found = np.zeros((zero.size, len(columns)))
    if shown:
        changes = [units[place] * columns[place][index] for place in shown]
        found[:, shown] = problem.white(changes, index)
    return found
