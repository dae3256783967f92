from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.course import Course, courses
from gripperd.diagnose.recording import Recording
from gripperd.diagnose.stages import (
    AtRest,
    Explanation,
    directions,
    passed_on,
    predictable,
    predicted,
    track_of,
)
from gripperd.diagnose.usable import usable
from gripperd.effects.coulomb_friction import CoulombFriction
from gripperd.effects.force_sensor_bias import ForceSensorBias
from gripperd.effects.length_datum import LengthDatum
from gripperd.effects.pressure_sensor_bias import PressureSensorBias
from gripperd.effects.series_compliance import SeriesCompliance
from gripperd.effects.threshold_pressure import ThresholdPressure
from gripperd.model.effect import Signal
from gripperd.model.track import Array
from tests.diagnose.small import (
    LINKAGE,
    MODEL,
    REGULATOR,
    moments,
    recording,
    textbook,
    with_jaws,
    without,
)
from tests.diagnose.sweep import noise, run, triangle

JAWED = replace(MODEL, linkage=LINKAGE)


def _courses(told: Recording) -> dict[str, Course]:
    return {course.run: course for course in courses(told, 0.25)[0]}


@pytest.fixture(scope="module")
def silent() -> dict[str, Course]:
    """The small rig with sensors that hardly make a noise."""
    return _courses(with_jaws(recording(noise=1e-3)))


def _one(model: Explanation, course: Course, signal: Signal) -> Array:
    return predicted(model, course, [signal], track_of(model, course, 0))[signal]


@pytest.mark.parametrize("name", ["a", "b", "c", "d", "e", "vented"])
def test_the_force_is_that_of_the_paper(silent: dict[str, Course], name: str) -> None:
    good = usable(silent[name], Signal.FORCE, 3.0)
    force = _one(MODEL, silent[name], Signal.FORCE)
    paper = textbook(moments()[name])
    np.testing.assert_allclose(force[good], paper[good], atol=0.5)


def test_the_pressure_is_that_of_the_line_and_ends_with_its_span() -> None:
    current = np.linspace(0.002, 0.024, 100)
    (course,) = courses(
        Recording("r", "0", (run(current=current, pressure=noise(100, 1e3)),)), 0.25
    )[0]
    line = 500e3 * (current - 0.004) / 0.016
    pressure = _one(MODEL, course, Signal.PRESSURE)
    np.testing.assert_allclose(pressure, np.clip(line, 0.0, 500e3), atol=1e-6)


def test_a_regulator_that_lags_follows_a_ramp_by_its_time_constant(
    silent: dict[str, Course],
) -> None:
    quick, slow = (
        _one(replace(MODEL, response=lag), silent["a"], Signal.PRESSURE)
        for lag in (0.0, 0.5)
    )
    # 500 kPa in 12.5 s; the lag is exact for steps, which adds half a sample.
    behind = (quick - slow)[20:45]
    np.testing.assert_allclose(behind, 40e3 * 0.5, rtol=0.25)


def test_the_opening_is_that_of_the_linkage(silent: dict[str, Course]) -> None:
    opening = _one(JAWED, silent["d"], Signal.OPENING)
    width = 0.085 - 4.0 * 0.25 * moments()["d"].contraction
    np.testing.assert_allclose(opening, width, atol=2e-4)


def test_the_grip_is_what_the_spring_leaves_and_never_negative() -> None:
    force = np.linspace(0.0, 800.0, 200)
    told = run(contraction=np.full(200, 0.08), force=force, grip=force / 4)
    (course,) = courses(Recording("r", "0", (told,)), 0.25)[0]
    spring = 240.0 + 1000.0 * 0.25 * 0.08
    np.testing.assert_allclose(
        _one(JAWED, course, Signal.GRIP),
        np.maximum((force - spring) / 4.0, 0.0),
        atol=1e-6,
    )


def test_an_effect_acts_on_its_own_signal_alone(silent: dict[str, Course]) -> None:
    rubbing = MODEL.with_effect(CoulombFriction(magnitude=20.0))
    turns = silent["d"].direction
    more = _one(rubbing, silent["d"], Signal.FORCE) - _one(
        MODEL, silent["d"], Signal.FORCE
    )
    np.testing.assert_allclose(more[turns != 0], -20.0 * turns[turns != 0])
    np.testing.assert_array_equal(
        _one(rubbing, silent["d"], Signal.PRESSURE),
        _one(MODEL, silent["d"], Signal.PRESSURE),
    )


def test_a_wrong_pressure_sensor_shows_in_two_stages_with_opposite_senses(
    silent: dict[str, Course],
) -> None:
    wrong = MODEL.with_effect(PressureSensorBias(bias=10e3))
    changes = {
        signal: _one(wrong, silent["a"], signal) - _one(MODEL, silent["a"], signal)
        for signal in (Signal.PRESSURE, Signal.FORCE)
    }
    np.testing.assert_allclose(changes[Signal.PRESSURE], 10e3)
    # Less pressure than is read, at the pull area of h = 0 by eq. (4).
    inflated = slice(10, 90)
    np.testing.assert_allclose(changes[Signal.FORCE][inflated], -25.7, atol=0.5)


def test_a_force_sensor_that_is_off_is_read_off(silent: dict[str, Course]) -> None:
    wrong = MODEL.with_effect(ForceSensorBias(bias=7.0))
    change = _one(wrong, silent["a"], Signal.FORCE) - _one(
        MODEL, silent["a"], Signal.FORCE
    )
    np.testing.assert_allclose(change, 7.0)


def test_what_happened_is_what_the_sensors_say_less_their_errors(
    silent: dict[str, Course],
) -> None:
    wrong = replace(
        MODEL.with_effect(LengthDatum(shift=0.01)), zeros={Signal.PRESSURE: 2e3}
    )
    course = silent["d"]
    told, plain = (track_of(one, course, 0) for one in (wrong, MODEL))
    np.testing.assert_allclose(told.contraction, plain.contraction - 0.01)
    np.testing.assert_allclose(told.pressure, plain.pressure - 2e3)


def test_a_zero_error_is_added_to_the_reading(silent: dict[str, Course]) -> None:
    shifted = replace(MODEL, zeros={Signal.FORCE: 4.0})
    change = _one(shifted, silent["a"], Signal.FORCE) - _one(
        MODEL, silent["a"], Signal.FORCE
    )
    np.testing.assert_allclose(change, 4.0)


def test_a_channel_that_is_read_early_is_ahead_by_its_rate(
    silent: dict[str, Course],
) -> None:
    early = replace(MODEL, skews={Signal.PRESSURE: 0.1})
    told, plain = (track_of(one, silent["a"], 0).pressure for one in (early, MODEL))
    # 40 kPa/s on the way up, so a tenth of a second is 4 kPa.
    np.testing.assert_allclose((plain - told)[5:45], 4e3, rtol=0.02)


def test_another_rest_length_is_another_contraction(silent: dict[str, Course]) -> None:
    longer = replace(
        MODEL, muscle=replace(MODEL.muscle, rest_length=0.26), told_length=0.25
    )
    course = silent["c"]
    length = 0.25 * (1 - course.level("contraction"))
    np.testing.assert_allclose(
        track_of(longer, course, 0).contraction, (0.26 - length) / 0.26
    )


def test_a_mount_that_stretches_hides_contraction(silent: dict[str, Course]) -> None:
    course = silent["e"]
    soft = MODEL.with_effect(SeriesCompliance(shortening=1e-5))
    pull = np.maximum(course.level("force"), 0.0)
    shorter = replace(
        MODEL, zeros={Signal.CONTRACTION: float(-1e-5 * pull[3])}
    )  # the same at the fourth sample
    assert _one(soft, course, Signal.FORCE)[3] == pytest.approx(
        _one(shorter, course, Signal.FORCE)[3], rel=1e-6
    )


def test_the_sign_of_friction_at_rest_is_assumed_until_there_is_travel() -> None:
    plain = without(recording(), "current")
    course = _courses(plain)["b"]
    signed = replace(MODEL, rests={4: -0.5})
    np.testing.assert_array_equal(directions(signed, course, 4), -0.5)
    np.testing.assert_array_equal(directions(signed, course, 5), 1.0)


def test_it_may_turn_with_the_pressure_instead() -> None:
    course = _courses(recording())["b"]
    turning = replace(MODEL, at_rest=AtRest.INFLATING)
    signs = directions(turning, course, 0)
    np.testing.assert_array_equal(signs[5:48], 1.0)
    np.testing.assert_array_equal(signs[56:], -1.0)


def test_where_there_was_travel_its_direction_counts() -> None:
    course = _courses(recording())["d"]
    for convention in AtRest:
        signs = directions(replace(MODEL, at_rest=convention), course, 0)
        assert set(signs[5:45]) == {1.0}
        assert set(signs[56:]) == {-1.0}


def test_an_effect_of_the_same_name_is_replaced() -> None:
    once = MODEL.with_effect(ThresholdPressure(pressure=1e3))
    twice = once.with_effect(ThresholdPressure(pressure=2e3))
    assert len(twice.effects) == len(once.effects) == len(MODEL.effects) + 1
    assert twice.effects[-1] == ThresholdPressure(pressure=2e3)


@pytest.mark.parametrize(
    ("missing", "signals"),
    [
        ((), (Signal.PRESSURE, Signal.FORCE, Signal.OPENING)),
        (("current",), (Signal.FORCE, Signal.OPENING)),
        (("contraction",), (Signal.PRESSURE,)),
        (("pressure", "opening"), ()),
    ],
)
def test_a_signal_is_predicted_where_it_and_its_inputs_were_measured(
    missing: tuple[str, ...], signals: tuple[Signal, ...]
) -> None:
    course = _courses(without(with_jaws(recording()), *missing))["d"]
    assert predictable(course) == signals


def test_samples_next_to_a_reversal_say_nothing_of_the_force(
    silent: dict[str, Course],
) -> None:
    bad = np.flatnonzero(~usable(silent["d"], Signal.FORCE, 3.0))
    turn = int(np.flatnonzero(np.diff(silent["d"].direction) < -1)[0])
    assert turn in bad
    assert bad[bad > 10].tolist() == list(range(turn - 1, turn + 4))


def test_samples_next_to_a_step_of_pressure_are_left_out() -> None:
    step = np.where(np.arange(100) < 50, 0.006, 0.012)
    told = run(current=step, pressure=REGULATOR.gain * (step - 0.004))
    (course,) = courses(Recording("r", "0", (told,)), 0.25)[0]
    good = usable(course, Signal.PRESSURE, 1e3)
    assert not good[48:53].any()
    assert good[:45].all()
    assert good[55:].all()


def test_a_slow_ramp_of_pressure_is_usable() -> None:
    course = _courses(recording())["a"]
    assert usable(course, Signal.PRESSURE, 1e3).all()


def test_jaws_without_an_object_say_nothing_of_the_grip() -> None:
    grip = np.where(np.arange(100) < 50, 0.2, 20.0)
    told = run(
        grip=grip,
        force=np.full(100, 400.0) + noise(100, 1.0),
        contraction=np.full(100, 0.1) + noise(100, 1e-4, 2),
    )
    (course,) = courses(Recording("r", "0", (told,)), 0.25)[0]
    np.testing.assert_array_equal(usable(course, Signal.GRIP, 0.1), grip > 10)


def test_a_missing_reading_is_not_usable() -> None:
    gap = triangle(100)
    gap[30:33] = np.nan
    told = run(force=gap, pressure=triangle(100), contraction=np.full(100, 0.1))
    (course,) = courses(Recording("r", "0", (told,)), 0.25)[0]
    assert not usable(course, Signal.FORCE, 1.0)[30:33].any()


def test_smooth_inputs_leave_out_no_more_than_their_noise() -> None:
    course = _courses(recording())["e"]
    track = track_of(MODEL, course, 0)
    left = passed_on(MODEL, course, track, Signal.FORCE)
    # 2e-4 of contraction at 400 kPa, where the pull falls by 5 to 6 kN per unit.
    assert np.std(left) < 2e-4 * 6e3
    assert passed_on(MODEL, course, track, Signal.PRESSURE) == 0.0
