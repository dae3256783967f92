from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.effects.coulomb_friction import CoulombFriction
from gripperd.effects.valve_offset import ValveOffset


@pytest.fixture
def start(blank: Problem) -> Point:
    return Point(np.zeros(len(blank.constants)))


def test_a_freed_constant_has_a_wide_prior(start: Point) -> None:
    freed = replace(start, freed=frozenset({1}))
    assert freed.widths[1] > 5.0
    assert set(np.delete(freed.widths, 1)) == {1.0}


def test_effects_of_a_point_come_and_go_by_name(start: Point) -> None:
    two = start.with_effect(ValveOffset()).with_effect(CoulombFriction())
    again = two.with_effect(ValveOffset(offset=5e3))
    assert {effect.name for effect in again.effects} == {
        "valve_offset",
        "coulomb_friction",
    }
    assert again.without("coulomb_friction").effects == (ValveOffset(offset=5e3),)


def test_looser_priors_hold_for_all_constants(start: Point) -> None:
    looser = tuple(2.0 for _ in start.shifts)
    point = replace(start, looser=looser, freed=frozenset({1}))
    assert set(point.widths) == {2.0}
