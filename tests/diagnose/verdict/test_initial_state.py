"""Friction at rest in sweeps that took no part."""

from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.residuals.holdout import Split
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.setup import problem_of
from gripperd.diagnose.verdict.initial_state import with_fitted_state, with_usual_state
from gripperd.effects.coulomb_friction import CoulombFriction
from gripperd.effects.rubber_elasticity import RubberElasticity
from tests.diagnose.small import MODEL, altered, recording


@pytest.mark.parametrize("shared", [-2.0, 0.0, 2.5])
def test_sweeps_left_out_rest_as_most_of_the_others(
    blank: Problem, shared: float
) -> None:
    out = {index for index, one in enumerate(blank.courses) if one.run == "b2"}
    kept = tuple(
        np.full(len(one), index not in out) for index, one in enumerate(blank.courses)
    )
    train = replace(blank, kept=kept)
    paths = [one.path for one in train.constants]
    shifts = np.zeros(len(paths))
    shifts[paths.index("rest.all")] = shared
    shifts[paths.index("rest.1")] = 1.5
    shifts[paths.index("rest.2")] = -1.0
    before, after = (
        train.explanation(point).rests
        for point in (Point(shifts), with_usual_state(train, Point(shifts)))
    )
    others = [sign for index, sign in before.items() if index not in out]
    assert len(out & before.keys()) == 1
    for index, sign in after.items():
        expected = np.median(others) if index in out else before[index]
        assert sign == pytest.approx(expected)


def test_sweeps_that_never_move_come_to_rest_like_those_that_do_not_either(
    blank: Problem,
) -> None:
    resting = {"b": 0.9, "c": 0.9, "vented": 0.9, "a": 0.9}
    place = {one.path: i for i, one in enumerate(blank.constants)}
    courses = {course.run: i for i, course in enumerate(blank.courses)}
    shifts = np.zeros(len(blank.constants))
    for run, sign in resting.items():
        index = place[f"rest.{courses[run]}"]
        shifts[index] = sign / blank.constants[index].sigma
    # As if one that rests were the first of a ride.
    ridden = tuple(
        replace(one, direction=np.where(one.time > one.time[5], 1.0, 0.0))
        if one.run == "a"
        else one
        for one in blank.courses
    )
    index = place[f"rest.{courses['a']}"]
    shifts[index] = -0.9 / blank.constants[index].sigma
    kept = tuple(np.full(len(course), course.run != "b2") for course in ridden)
    train = replace(blank, courses=ridden, kept=kept)
    point = with_usual_state(train, Point(shifts))
    sign = train.explanation(point).rests[courses["b2"]]
    assert sign == pytest.approx(0.9, abs=1e-6)


def _left_out(problem: Problem, run: str) -> tuple[Split, int]:
    """A split that leaves out one sweep, and its place."""
    (place,) = (i for i, one in enumerate(problem.courses) if one.run == run)
    kept = tuple(
        np.full(len(one), index == place) for index, one in enumerate(problem.courses)
    )
    test = replace(problem, kept=kept)
    train = replace(problem, kept=tuple(~mask for mask in kept))
    return Split(train, test, (run,)), place


def _resting(problem: Problem, sign: float, left_out: int) -> Point:
    """A point at which all sweeps rest alike but the one left out."""
    shifts = np.zeros(len(problem.constants))
    for index, constant in enumerate(problem.constants):
        if constant.course not in (None, left_out):
            shifts[index] = sign / constant.sigma
    return Point(shifts)


@pytest.mark.parametrize("shared", [0.0, 0.8, 0.95])
@pytest.mark.parametrize("others", [-0.9, 0.0, 0.9])
@pytest.mark.parametrize("sign", [-1.0, -0.5, 0.0, 1.0])
def test_a_sweep_left_out_has_the_sign_that_its_samples_tell(
    sign: float, others: float, shared: float
) -> None:
    # Dry friction of 400 N, and the rig came to rest with a part of it in that sweep.
    told = altered(recording(), ("b2",), "force", lambda force: force - 400.0 * sign)
    problem = problem_of(told, MODEL, {})
    parts, place = _left_out(problem, "b2")
    friction = CoulombFriction(magnitude=400.0)
    point = _resting(problem, others, place).with_effect(friction)
    index = [one.path for one in problem.constants].index("rest.all")
    point.shifts[index] = shared / problem.constants[index].sigma
    before = problem.explanation(point).rests
    after = problem.explanation(with_fitted_state(parts, point)).rests
    # Beside it the friction of the textbook, 16 N at most, has the sign 1.
    assert after[place] == pytest.approx(sign, abs=0.08)
    assert after == pytest.approx({**before, place: after[place]})


def test_a_sign_that_shows_nowhere_is_the_usual_one(blank: Problem) -> None:
    model = replace(blank.model, effects=(RubberElasticity(),))
    parts, place = _left_out(replace(blank, model=model), "b2")
    point = _resting(blank, 0.4, place)
    told = blank.explanation(with_fitted_state(parts, point)).rests[place]
    assert told == pytest.approx(0.4, abs=1e-3)
