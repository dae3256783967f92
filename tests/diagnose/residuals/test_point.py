from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.stats import norm

from gripperd.diagnose.residuals.point import FREED, Point
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


@pytest.mark.parametrize("off", [-4.0, 14.0])
def test_a_wrong_constant_is_off_as_by_a_tolerance_that_is_hardly_known(
    start: Point, off: float
) -> None:
    """Normal distributions, mixed over a precision that may be anything about 1."""
    shifts = start.shifts.copy()
    shifts[1] = off
    freed = replace(start, shifts=shifts, freed=frozenset({1}))

    def density(precision: float) -> float:
        sigma = precision**-0.5
        return float(np.exp(-precision) * norm.pdf(off, scale=sigma))

    mixed, _ = quad(density, 0.0, np.inf)
    looked_for = norm.logpdf(off, scale=FREED)
    assert freed.surprise == pytest.approx(looked_for - np.log(mixed), abs=1e-6)


@pytest.mark.parametrize("off", [0.0, -2.0, 2.7])
def test_a_constant_near_its_tolerance_is_no_better_for_being_freed(
    start: Point, off: float
) -> None:
    shifts = start.shifts.copy()
    shifts[1] = off
    assert replace(start, shifts=shifts, freed=frozenset({1})).surprise == 0.0


def test_constants_that_hold_or_are_looser_surprise_nobody(start: Point) -> None:
    shifts = np.full_like(start.shifts, 3.0)
    looser = tuple(3.0 for _ in shifts)
    assert replace(start, shifts=shifts).surprise == 0.0
    freed = frozenset({1})
    assert replace(start, shifts=shifts, freed=freed, looser=looser).surprise == 0.0


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


def test_one_that_is_changed_acts_in_its_turn(start: Point) -> None:
    first, second = CoulombFriction(magnitude=5.0), ValveOffset()
    point = replace(start, effects=(first, second))
    more = CoulombFriction(magnitude=9.0)
    assert point.changed(more).effects == (more, second)
    assert point.with_effect(more).effects == (second, more)
