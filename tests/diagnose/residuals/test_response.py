from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.residuals.constants import Constant
from gripperd.diagnose.residuals.explanation import moves
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.residuals.response import responses, sensitivities
from gripperd.diagnose.setup import problem_of
from gripperd.effects.coulomb_friction import CoulombFriction
from gripperd.effects.creep import Creep
from gripperd.effects.force_sensor_bias import ForceSensorBias
from gripperd.effects.linkage_friction import LinkageFriction, Turning
from gripperd.effects.series_compliance import SeriesCompliance
from gripperd.effects.threshold_pressure import ThresholdPressure
from gripperd.effects.valve_offset import ValveOffset
from gripperd.model.effect import Effect, Signal
from gripperd.model.track import Array
from tests.diagnose.small import LINKAGE, MODEL, recording, with_grip


@pytest.fixture
def start(blank: Problem) -> Point:
    return Point(np.zeros(len(blank.constants)))


def _of(problem: Problem, pieces: list[Array], signal: Signal) -> Array:
    return np.concatenate(
        [
            piece
            for block, piece in zip(problem.blocks, pieces, strict=True)
            if block.signal is signal
        ]
    )


def _index(problem: Problem, path: str) -> int:
    return [one.path for one in problem.constants].index(path)


def test_a_zero_error_shows_as_itself_and_nowhere_else(
    blank: Problem, start: Point
) -> None:
    index = _index(blank, "zero.force")
    response = sensitivities(blank, start)[index]
    force = _of(blank, response, Signal.FORCE)
    np.testing.assert_allclose(force, blank.constants[index].sigma)
    assert not _of(blank, response, Signal.PRESSURE).any()


def test_a_sensitivity_is_the_slope_in_the_constant(
    blank: Problem, start: Point
) -> None:
    index = _index(blank, "valve.pressure_high")
    response = sensitivities(blank, start)[index]
    share = [
        (blank.courses[block.course].column("current")[block.good] - 0.004) / 0.016
        for block in blank.blocks
    ]
    sigma = blank.constants[index].sigma
    # The regulator follows by 20 ms, 800 Pa of 500 kPa, so the slope is near the line.
    expected = sigma * _of(blank, share, Signal.PRESSURE)
    found = _of(blank, response, Signal.PRESSURE)
    np.testing.assert_allclose(found, expected, atol=0.01 * sigma)


def test_the_sign_at_rest_changes_its_own_sweep_alone(
    blank: Problem, start: Point
) -> None:
    index = next(
        i for i, one in enumerate(blank.constants) if one.path.startswith("rest.")
    )
    course = blank.constants[index].course
    slopes = sensitivities(blank, start)[index]
    for block, response in zip(blank.blocks, slopes, strict=True):
        if block.course != course:
            assert not response.any()


def test_joints_that_rub_as_they_came_feel_the_sign_at_rest() -> None:
    model = replace(MODEL, linkage=LINKAGE)
    squeezed = problem_of(with_grip(recording()), model, {})
    free = Point(np.zeros(len(squeezed.constants)))
    rubbing = free.with_effect(LinkageFriction(loss=0.1, by=Turning.TRAVEL))
    # The first is vented, and presses on nothing.
    (_, index, *_) = (
        i for i, one in enumerate(squeezed.constants) if one.path.startswith("rest.")
    )
    sign = squeezed.constants[index]
    grips = squeezed.expected(squeezed.explanation(free))
    slopes = sensitivities(squeezed, rubbing)[index]
    (place,) = (
        i
        for i, block in enumerate(squeezed.blocks)
        if (block.course, block.signal) == (sign.course, Signal.GRIP)
    )
    assert grips[place].max() > 100.0
    assert slopes[place] == pytest.approx(-0.1 * sign.sigma * grips[place], abs=1e-9)


@pytest.mark.parametrize("end", [-1, 1])
def test_a_sign_at_rest_is_felt_at_either_end_of_its_reach(
    blank: Problem, start: Point, end: int
) -> None:
    # The muscle of the first, which is vented, rubs on nothing.
    index = [
        i for i, one in enumerate(blank.constants) if one.path.startswith("rest.")
    ][1]
    middle = sensitivities(blank, start)[index]
    assert any(one.any() for one in middle)
    shifts = start.shifts.copy()
    shifts[index] = end * blank.reach(start)[index]
    there = sensitivities(blank, replace(start, shifts=shifts))[index]
    for one, other in zip(there, middle, strict=True):
        # A sign of 1.04 counts as 1, so that a third of the step goes nowhere.
        assert np.abs(one).sum() >= 0.5 * np.abs(other).sum()
        assert (one * other).sum() >= 0.0


def test_a_size_of_an_effect_is_felt_at_its_highest(blank: Problem) -> None:
    """There no step leads on, but one back."""
    rubs = CoulombFriction(magnitude=290.0)
    size = Constant(
        "effects.coulomb_friction.magnitude_N", 290.0, 29.0, stated=False, effect=rubs
    )
    problem = replace(
        blank,
        model=replace(blank.model, effects=(*blank.model.effects, rubs)),
        constants=(size,),
    )
    # Of what may be 300 N at most; two tolerances would be 348.
    ends = np.concatenate(problem.ends(Point(np.zeros(1))))
    np.testing.assert_allclose(ends, [-2.0, 10 / 29])
    slopes = [
        np.concatenate(sensitivities(problem, Point(np.array([shift])))[0])
        for shift in (0.0, 10 / 29)
    ]
    assert slopes[0].any()
    np.testing.assert_allclose(slopes[1], slopes[0])


def test_a_response_is_that_of_one_scale(blank: Problem, start: Point) -> None:
    (response,) = responses(blank, start, ForceSensorBias(bias=123.0))
    np.testing.assert_allclose(_of(blank, response, Signal.FORCE), 5.0)


def test_every_amplitude_has_a_response_of_its_own(
    blank: Problem, start: Point
) -> None:
    fast, medium, slow = responses(blank, start, Creep(fast=1.0, medium=1.0, slow=1.0))
    late = [
        np.abs(_of(blank, one, Signal.FORCE)).mean() for one in (fast, medium, slow)
    ]
    assert 0 < late[0] < late[1] < late[2]


def test_of_an_effect_that_acts_the_response_is_the_slope_there(
    blank: Problem, start: Point
) -> None:
    acting = ThresholdPressure(pressure=100e3)
    there = start.with_effect(acting)
    (slope,) = responses(blank, there, acting)
    (whole,) = responses(blank, start, ThresholdPressure(pressure=20e3))
    low = np.concatenate(
        [
            blank.courses[b.course].level("pressure")[b.good]
            for b in blank.blocks
            if b.signal is Signal.FORCE
        ]
    )
    held = (low > 30e3) & (low < 95e3)
    assert held.sum() > 20
    # Below the threshold nothing pulls, so more threshold takes nothing more.
    np.testing.assert_allclose(_of(blank, slope, Signal.FORCE)[held], 0.0, atol=1e-9)
    assert np.abs(_of(blank, whole, Signal.FORCE)[held]).min() > 5.0


@pytest.mark.parametrize(
    ("effect", "signals"),
    [
        (CoulombFriction(), {Signal.FORCE}),
        (ValveOffset(), {Signal.PRESSURE}),
        (SeriesCompliance(compliance=1e-5), {Signal.OPENING}),
        (SeriesCompliance(shortening=1e-5), {Signal.OPENING, Signal.FORCE}),
    ],
)
def test_an_effect_changes_these_signals(effect: Effect, signals: set[Signal]) -> None:
    assert set(moves(effect) or ()) == signals


def test_a_sensor_may_change_every_signal() -> None:
    assert moves(ForceSensorBias()) is None
