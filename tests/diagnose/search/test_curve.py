from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.noise.model import Noise
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.curve import beyond_curves
from gripperd.diagnose.setup import problem_of
from gripperd.effects.coulomb_friction import CoulombFriction
from gripperd.effects.nonlinear_elasticity import NonlinearElasticity
from gripperd.model.effect import Effect, Signal
from gripperd.model.track import Array
from tests.diagnose.small import MODEL, Hidden, Moment, recording

RUBS = CoulombFriction(magnitude=20.0)
STIFFENS = NonlinearElasticity(saturation=-60.0, contraction=0.05)


def _rubs(moment: Moment) -> Array:
    return -20.0 * moment.direction


def _stiffens(moment: Moment) -> Array:
    return -60.0 * (1 - np.exp(-moment.contraction / 0.05))


def _beyond(problem: Problem, effect: Effect) -> float:
    point = Point(np.zeros(len(problem.constants)), effects=(effect,))
    return beyond_curves(problem, point, effect)


def _bare(hidden: Hidden) -> Problem:
    """With sensors of 3 N whose noise has no memory, and that do not drift."""
    problem = problem_of(recording(hidden), MODEL, {})
    quick = {s: Noise(one.std, 0.0) for s, one in problem.noises.items()}
    return replace(problem, noises=quick | {Signal.FORCE: Noise(3.0, 0.0)})


def test_a_loop_is_likelier_by_the_variance_between_there_and_back() -> None:
    """By the book: sums of squares between the two ways, length by length."""
    problem = _bare(_rubs)
    left = problem.residuals(Point(np.zeros(len(problem.constants))))
    between = 0.0
    for place, block in enumerate(problem.blocks):
        course = problem.courses[block.course]
        if block.signal is not Signal.FORCE or not course.direction.any():
            continue
        way = course.direction[block.good]
        length = np.floor(course.level("contraction")[block.good] / 0.02)
        for one in np.unique(length):
            there, back = (left[place][(length == one) & (way == d)] for d in (1, -1))
            if there.size and back.size:
                share = there.size * back.size / (there.size + back.size)
                between += share * (there.mean() - back.mean()) ** 2
    assert _beyond(problem, RUBS) == pytest.approx(0.5 * between / 3.0**2, rel=0.1)


def test_a_curve_has_nothing_that_no_curve_gives() -> None:
    assert _beyond(problem_of(recording(_stiffens), MODEL, {}), STIFFENS) < 0


def test_a_loop_the_wrong_way_round_speaks_against_itself() -> None:
    problem = problem_of(recording(lambda at: -_rubs(at)), MODEL, {})
    assert _beyond(problem, RUBS) < 0


def test_what_changes_nothing_gains_nothing() -> None:
    problem = problem_of(recording(_rubs), MODEL, {})
    assert _beyond(problem, replace(RUBS, magnitude=0.0)) == 0


@pytest.mark.parametrize("every", [9, 20])
def test_few_samples_are_not_taken_up_by_curves(every: int) -> None:
    """Of 45 polynomials all would go through 13 samples."""
    problem = _bare(_rubs)
    kept = tuple(np.arange(len(one)) % every == 0 for one in problem.courses)
    few = replace(problem, kept=kept)
    sizes = [
        sum(int(b.good.sum()) for b in one.blocks if b.signal is Signal.FORCE)
        for one in (problem, few)
    ]
    usual = _beyond(problem, RUBS) / sizes[0]
    assert _beyond(few, RUBS) / sizes[1] == pytest.approx(usual, rel=0.25)
