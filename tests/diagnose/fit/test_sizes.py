"""Sizes from which a fit begins."""

from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.fit.sizes import sized
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.setup import problem_of
from gripperd.effects.valve_dead_band import Spool, ValveDeadBand
from gripperd.effects.valve_offset import ValveOffset
from tests.diagnose.sleeping import ladders, sleeps, stuck
from tests.diagnose.small import MODEL

USUAL = ValveDeadBand(width=15e3, spool=Spool.WAKES)


def _problem(band: float) -> Problem:
    return problem_of(stuck(sleeps, band, asked=ladders()), MODEL, {})


@pytest.mark.parametrize("band", [6e3, 12e3, 30e3])
def test_a_threshold_begins_where_it_explains_most(band: float) -> None:
    problem = _problem(band)
    start = Point(np.zeros(len(problem.constants)))
    (found,) = sized(problem, start.with_effect(USUAL)).effects
    assert isinstance(found, ValveDeadBand)
    assert found.width == pytest.approx(band, rel=0.2)
    assert replace(found, width=USUAL.width) == USUAL


def test_what_has_been_fitted_or_is_no_threshold_stays() -> None:
    problem = _problem(30e3)
    start = Point(np.zeros(len(problem.constants)))
    for effect in (replace(USUAL, width=14e3), ValveOffset(offset=2e3)):
        point = start.with_effect(effect)
        assert sized(problem, point) is point
