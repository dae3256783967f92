from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.readings.recording import Recording, Run
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.setup import problem_of
from gripperd.errors import InputError
from gripperd.model.effect import Signal
from gripperd.model.track import Array
from tests.diagnose.small import (
    MODEL,
    Moment,
    altered,
    nothing,
    recording,
    tabled,
    textbook,
    without,
)

ALL = ("vented", "a", "b", "c", "d", "e", "b2", "f")


def _paths(problem: Problem) -> dict[str, float]:
    return {one.path: one.sigma for one in problem.constants}


def test_a_stated_tolerance_is_used(blank: Problem) -> None:
    stated = problem_of(recording(), MODEL, {"muscle.diameter": 1e-6})
    assert _paths(stated)["muscle.diameter"] == 1e-6
    assert _paths(blank)["muscle.diameter"] > 1e-5


def test_every_sweep_without_travel_has_a_sign_at_rest(blank: Problem) -> None:
    still = {i for i, course in enumerate(blank.courses) if course.run not in "def"}
    signs = {f"rest.{i}" for i in still} | {"rest.all"}
    assert {path for path in _paths(blank) if path.startswith("rest.")} == signs


def test_a_rig_that_measures_a_push_is_never_slack(blank: Problem) -> None:
    force = np.concatenate([course.column("force") for course in blank.courses])
    assert force.min() < -50.0
    assert blank.slack == -np.inf


def test_below_the_noise_a_cord_may_be_slack() -> None:
    corded = altered(recording(), ALL, "force", lambda f: np.maximum(f, 0.0) + 0.1)
    problem = problem_of(corded, MODEL, {})
    assert 0 < problem.slack < 30.0
    left = np.concatenate(
        [
            problem.courses[b.course].level("force")[b.good]
            for b in problem.blocks
            if b.signal is Signal.FORCE
        ]
    )
    assert left.min() > problem.slack


def test_neighbours_in_a_table_are_no_repeats_of_each_other() -> None:
    def corded(moment: Moment) -> Array:
        return np.maximum(textbook(moment), 0.0) - textbook(moment)

    problem = problem_of(tabled(corded, size=9), MODEL, {})
    # Steps between points are 300 N and more; their noise is 3 N.
    assert 0 < problem.slack < 0.13 * problem.full_scale[Signal.FORCE]


def _lengths(told: Recording) -> Recording:
    """The same with the length in place of the contraction."""
    runs = [
        Run(
            run.name,
            {
                **{k: v for k, v in run.columns.items() if k != "contraction"},
                "length": 0.25 * (1 - run.columns["contraction"]),
            },
        )
        for run in told.runs
    ]
    return Recording(told.name, told.digest, tuple(runs))


def test_a_recorded_length_is_as_good_as_a_contraction(blank: Problem) -> None:
    problem = problem_of(_lengths(recording()), MODEL, {})
    start = Point(np.zeros(len(blank.constants)))
    assert problem.model.told_length == 0.25
    for one, other in zip(
        problem.residuals(start), blank.residuals(start), strict=True
    ):
        np.testing.assert_allclose(one, other, atol=1e-6)


def test_a_rest_length_that_is_off_shifts_a_length_not_a_contraction() -> None:
    longer = replace(MODEL, muscle=replace(MODEL.muscle, rest_length=0.252))
    by_length = problem_of(_lengths(recording()), longer, {})
    first = by_length.courses[0].level("contraction")
    np.testing.assert_allclose(first, 0.002 / 0.252, atol=5e-4)


def test_without_current_the_valve_is_no_part_of_the_problem() -> None:
    problem = problem_of(without(recording(nothing), "current"), MODEL, {})
    assert problem.signals == (Signal.FORCE,)
    assert not any(p.startswith("response") for p in _paths(problem))


@pytest.mark.parametrize("alone", ["current", "pressure", "force"])
def test_a_column_alone_cannot_be_compared_with_anything(alone: str) -> None:
    columns = {"current", "pressure", "contraction", "force"} - {alone}
    with pytest.raises(InputError):
        problem_of(without(recording(), *columns), MODEL, {})
