from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.noise import Noise
from gripperd.diagnose.problem import Point, Problem, moves
from gripperd.diagnose.setup import problem_of
from gripperd.effects.coulomb_friction import CoulombFriction
from gripperd.effects.creep import Creep
from gripperd.effects.force_sensor_bias import ForceSensorBias
from gripperd.effects.series_compliance import SeriesCompliance
from gripperd.effects.threshold_pressure import ThresholdPressure
from gripperd.effects.valve_offset import ValveOffset
from gripperd.model.effect import Effect, Signal
from gripperd.model.track import Array
from tests.diagnose.small import (
    FORCE_NOISE,
    MODEL,
    PRESSURE_NOISE,
    recording,
    with_jaws,
)


@pytest.fixture
def start(blank: Problem) -> Point:
    return Point(np.zeros(len(blank.constants)))


@pytest.fixture
def truth(blank: Problem) -> Point:
    """The rig came to rest contracting, and its regulator follows at once."""
    built = {"rest": 1.0, "response": 0.0}
    shifts = [
        (built.get(one.path.partition(".")[0], one.nominal) - one.nominal) / one.sigma
        for one in blank.constants
    ]
    return Point(np.array(shifts))


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


def test_of_a_true_model_only_the_noise_is_left(blank: Problem, truth: Point) -> None:
    residuals = blank.residuals(truth)
    for signal, noise in (
        (Signal.FORCE, FORCE_NOISE),
        (Signal.PRESSURE, PRESSURE_NOISE),
    ):
        left = _of(blank, residuals, signal)
        assert np.std(left) == pytest.approx(noise, rel=0.2)
        assert abs(np.mean(left)) < 4 * noise / left.size**0.5


def test_whitened_it_has_unit_variance(blank: Problem, truth: Point) -> None:
    white = np.concatenate(
        [blank.white([r], i)[:, 0] for i, r in enumerate(blank.residuals(truth))]
    )
    assert np.mean(white**2) == pytest.approx(1.0, abs=0.12)


def test_a_signal_without_its_part_of_the_model_is_not_explained() -> None:
    told = with_jaws(recording())
    assert Signal.OPENING not in problem_of(told, MODEL, {}).signals
    bare = problem_of(told, replace(MODEL, regulator=None), {})
    assert bare.signals == (Signal.FORCE,)


def test_samples_that_are_not_kept_take_no_part(blank: Problem) -> None:
    masks = tuple(np.arange(len(course)) < 10 for course in blank.courses)
    part = replace(blank, kept=masks)
    assert part.signals == blank.signals
    assert all(time[-1] - time[0] < 2.5 for time in part.times)


def test_a_slack_muscle_tells_nothing(blank: Problem) -> None:
    taut = replace(blank, slack=100.0)
    force = _of(taut, taut.measured, Signal.FORCE)
    assert force.min() > 100.0 - 4 * FORCE_NOISE
    assert (
        _of(taut, taut.measured, Signal.PRESSURE).size
        == _of(blank, blank.measured, Signal.PRESSURE).size
    )


def test_the_full_scale_is_the_largest_reading(blank: Problem) -> None:
    readings = [course.column("force") for course in blank.courses]
    top = float(np.max(np.concatenate(readings)))
    assert blank.full_scale[Signal.FORCE] == pytest.approx(top, rel=0.01)


def test_a_zero_error_shows_as_itself_and_nowhere_else(
    blank: Problem, start: Point
) -> None:
    index = _index(blank, "zero.force")
    response = blank.sensitivities(start)[index]
    force = _of(blank, response, Signal.FORCE)
    np.testing.assert_allclose(force, blank.constants[index].sigma)
    assert not _of(blank, response, Signal.PRESSURE).any()


def test_a_sensitivity_is_the_slope_in_the_constant(
    blank: Problem, start: Point
) -> None:
    index = _index(blank, "valve.pressure_high")
    response = blank.sensitivities(start)[index]
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
    responses = blank.sensitivities(start)[index]
    for block, response in zip(blank.blocks, responses, strict=True):
        if block.course != course:
            assert not response.any()


def test_a_response_is_that_of_one_scale(blank: Problem, start: Point) -> None:
    (response,) = blank.responses(start, ForceSensorBias(bias=123.0))
    np.testing.assert_allclose(_of(blank, response, Signal.FORCE), 5.0)


def test_every_amplitude_has_a_response_of_its_own(
    blank: Problem, start: Point
) -> None:
    fast, medium, slow = blank.responses(start, Creep(fast=1.0, medium=1.0, slow=1.0))
    late = [
        np.abs(_of(blank, one, Signal.FORCE)).mean() for one in (fast, medium, slow)
    ]
    assert 0 < late[0] < late[1] < late[2]


def test_of_an_effect_that_acts_the_response_is_the_slope_there(
    blank: Problem, start: Point
) -> None:
    acting = ThresholdPressure(pressure=100e3)
    there = start.with_effect(acting)
    (slope,) = blank.responses(there, acting)
    (whole,) = blank.responses(start, ThresholdPressure(pressure=20e3))
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


def test_a_louder_noise_whitens_to_less(blank: Problem, start: Point) -> None:
    residual = blank.residuals(start)[0]
    signal = blank.blocks[0].signal
    twice = replace(blank, noises={**blank.noises, signal: Noise(2e3, 0.0)})
    once = replace(blank, noises={**blank.noises, signal: Noise(1e3, 0.0)})
    np.testing.assert_allclose(
        2 * twice.white([residual], 0), once.white([residual], 0), rtol=1e-6
    )
