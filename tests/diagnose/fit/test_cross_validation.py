from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.fit.cross_validation import bears_out, foretold
from gripperd.diagnose.fit.polish import polished
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.setup import problem_of
from gripperd.effects.creep import Creep
from gripperd.effects.first_cycle import FirstCycle
from gripperd.effects.force_sensor_bias import ForceSensorBias
from gripperd.model.effect import Effect, Signal
from tests.diagnose.small import MODEL, Hidden, nothing, pinned, recording, rubbing

FORCE = frozenset({Signal.FORCE})


def _problem(hidden: Hidden) -> Problem:
    problem = problem_of(recording(hidden), MODEL, {})
    return pinned(problem, "muscle.diameter", "zero.force")


def _with(problem: Problem, *effects: Effect) -> Point:
    return Point(np.zeros(len(problem.constants)), effects)


@pytest.mark.parametrize("sweep", [1, 3, 6])
def test_a_sweep_is_foretold_as_by_a_fit_that_never_saw_it(sweep: int) -> None:
    problem = _problem(lambda m: 8.0 + 0.02 * m.time)
    start = _with(problem, ForceSensorBias(bias=5.0))
    found = foretold(problem, polished(problem, start))
    kept = tuple(
        np.full(len(course), index != sweep)
        for index, course in enumerate(problem.courses)
    )
    blind = polished(replace(problem, kept=kept), start).point
    left = problem.residuals(blind)
    for index, block in enumerate(problem.blocks):
        if block.course == sweep:
            white = problem.white([left[index]], index)[:, 0]
            assert found[index] == pytest.approx(float(white @ white), rel=1e-3)


def test_what_acts_in_every_sweep_is_borne_out() -> None:
    problem = _problem(lambda m: 8.0 + 0 * m.time)
    small = polished(pinned(problem, "muscle.diameter"), Point(np.zeros(1)))
    bare = pinned(problem, "muscle.diameter")
    large = polished(bare, _with(bare, ForceSensorBias(bias=5.0)))
    assert bears_out(bare, small, large, FORCE)
    assert not bears_out(bare, large, small, FORCE)


def test_what_fits_noise_is_not_borne_out() -> None:
    problem = _problem(nothing)
    small = polished(problem, _with(problem))
    large = polished(problem, _with(problem, Creep(slow=-0.01)))
    assert large.misfits[Signal.FORCE] < small.misfits[Signal.FORCE]
    assert not bears_out(problem, small, large, FORCE)


def test_what_only_one_sweep_shows_is_not_held_against_it() -> None:
    problem = _problem(
        lambda m: np.where(m.time < 120.0, -20.0, 0.0) * m.pressure / 5e5
    )
    small = polished(problem, _with(problem))
    large = polished(problem, _with(problem, FirstCycle()))
    assert bears_out(problem, small, large, FORCE)


def test_with_too_few_sweeps_nothing_speaks_against_it() -> None:
    problem = _problem(rubbing(10.0))
    kept = tuple(
        np.full(len(course), index < 4) for index, course in enumerate(problem.courses)
    )
    problem = replace(problem, kept=kept)
    small = polished(problem, _with(problem))
    assert bears_out(problem, small, small, FORCE)
