from dataclasses import fields, replace
from typing import Any

import numpy as np
import pytest

from gripperd.diagnose.noise.smoothing import Smooth
from gripperd.diagnose.readings.course import Course
from gripperd.diagnose.readings.cutting import courses
from gripperd.diagnose.readings.recording import Recording
from gripperd.diagnose.residuals.explanation import AtRest
from gripperd.diagnose.residuals.runs import Runs
from gripperd.diagnose.residuals.track import directions, track_of
from gripperd.effects.channel_delay import ChannelDelay
from gripperd.effects.length_datum import LengthDatum
from gripperd.model.effect import Signal
from gripperd.model.track import Array
from tests.diagnose.small import (
    MODEL,
    REGULATOR,
    STEP,
    altered,
    moments,
    recording,
    with_jaws,
    without,
)


def _courses(told: Recording) -> dict[str, Course]:
    return {course.run: course for course in courses(told, 0.25)[0]}


@pytest.fixture(scope="module")
def silent() -> dict[str, Course]:
    """The small rig with sensors that hardly make a noise."""
    return _courses(with_jaws(recording(noise=1e-3)))


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


def test_a_channel_that_is_read_early_is_ahead_by_its_rate(
    silent: dict[str, Course],
) -> None:
    early = replace(MODEL, skews={Signal.PRESSURE: 0.1})
    told, plain = (track_of(one, silent["a"], 0).pressure for one in (early, MODEL))
    # 40 kPa/s on the way up, so a tenth of a second is 4 kPa.
    np.testing.assert_allclose((plain - told)[5:45], 4e3, rtol=0.02)


def test_a_late_force_is_as_noisy_where_it_is_not_read() -> None:
    def halved(column: Array) -> Array:
        return np.where(np.arange(column.size) % 2 == 0, column, np.nan)

    course = _courses(altered(recording(), moments(), "force", halved))["a"]
    # Past the middle of the way to the next row, in which there is no reading.
    late = ChannelDelay(delay=0.6 * STEP, channel=Signal.FORCE)
    track = track_of(MODEL.with_effect(late), course, 0)
    own = (course.column("force") - course.level("force"))[:-2:2]
    told = own + track.beside[:-2:2]
    following = (course.column("force") - course.level("force"))[2::2]
    # Either neighbour is as near: one of the two readings, never none.
    nearer = np.isclose(told, own) | np.isclose(told, following)
    assert nearer.all()


def test_another_rest_length_is_another_contraction(silent: dict[str, Course]) -> None:
    longer = replace(
        MODEL, muscle=replace(MODEL.muscle, rest_length=0.26), told_length=0.25
    )
    course = silent["c"]
    length = 0.25 * (1 - course.level("contraction"))
    np.testing.assert_allclose(
        track_of(longer, course, 0).contraction, (0.26 - length) / 0.26
    )


@pytest.mark.parametrize(
    ("change", "named"),
    [
        ({"regulator": replace(REGULATOR, pressure_high=4e5)}, "command"),
        ({"regulator": None}, "command"),
        ({"vents": -2e4}, "command"),
        ({"zeros": {Signal.PRESSURE: 2e3}}, "pressure"),
        ({"skews": {Signal.PRESSURE: 0.1}}, "pressure"),
        ({"zeros": {Signal.CONTRACTION: 0.01}}, "contraction"),
        ({"skews": {Signal.CONTRACTION: 0.1}}, "contraction"),
        ({"told_length": 0.3}, "contraction"),
        ({"zeros": {Signal.FORCE: 2.0}}, "force"),
        ({"rests": {0: -0.5}}, "direction"),
        ({"rests": {0: -0.5}}, "came"),
        ({"stiction": 0.1}, "direction"),
        ({"at_rest": AtRest.INFLATING}, "direction"),
        ({"at_rest": AtRest.BLADDER}, "sliding"),
    ],
)
def test_what_was_told_of_another_model_does_not_stay(
    silent: dict[str, Course], change: dict[str, Any], named: str
) -> None:
    course = silent["d"] if named == "contraction" else silent["b"]
    other = replace(MODEL, **change)
    before = track_of(MODEL, course, 0)
    told = track_of(other, course, 0)
    # Of a course that nothing was told of before.
    fresh = track_of(other, replace(course), 0)
    for one in fields(Runs):
        np.testing.assert_equal(getattr(told, one.name), getattr(fresh, one.name))
    assert not np.array_equal(
        getattr(told, named), getattr(before, named), equal_nan=True
    )
    again = track_of(MODEL, course, 0)
    np.testing.assert_array_equal(getattr(again, named), getattr(before, named))


@pytest.mark.parametrize("named", ["time", "command", "pressure", "contraction"])
def test_what_is_told_once_is_not_written_to(
    silent: dict[str, Course], named: str
) -> None:
    column = getattr(track_of(MODEL, silent["b"], 0), named)
    with pytest.raises(ValueError, match="read-only"):
        column[0] = 0.0


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
    np.testing.assert_allclose(signs[5:48], 1.0)
    np.testing.assert_allclose(signs[56:], -1.0)


@pytest.mark.parametrize(
    ("convention", "share", "half"),
    [
        (AtRest.INFLATING, 1.0, 5), (AtRest.INFLATING, 0.2, 3),
        (AtRest.YIELDING, 0.8, 10),
    ],
)  # fmt: skip
def test_it_turns_from_where_the_rig_came_over_a_way(
    convention: AtRest, share: float, half: int
) -> None:
    plain = _courses(recording())["b"]
    # Up by 1 kPa a sample to 500 kPa, or 100, and back by 50.
    top = round(500 * share)
    swept = 1e3 * np.append(np.arange(0.0, top), np.arange(top, top - 50.0, -1.0))
    zero = np.zeros_like(swept)
    course = replace(
        plain,
        time=np.linspace(0.0, 0.1 * (swept.size - 1), swept.size),
        step=zero + 0.1,
        measured={"pressure": swept},
        smooth={},
        direction=zero,
    )
    turning = replace(MODEL, at_rest=convention, rests={0: -0.4})
    signs = directions(turning, course, 0)
    # Half the way is 1 % of the range, or 2.5, and 3 kPa at least.
    np.testing.assert_allclose(signs[[0, 1]], [-0.4, -0.4 + 1 / half])
    np.testing.assert_allclose(signs[2 * half : top + 1], 1.0)
    np.testing.assert_allclose(signs[top + half], 0.0, atol=1e-9)
    np.testing.assert_allclose(signs[top + 2 * half :], -1.0)


def test_where_it_halts_it_turns_with_the_pressure_until_it_travels_again() -> None:
    plain = _courses(recording())["b"]
    # There in 20 samples, up by 5 kPa a sample to 300 and back; and home from 170 on.
    swept = 1e5 + 5e3 * np.interp(np.arange(200.0), [20, 60, 100], [0, 40, 0])
    came = np.where(np.arange(200) < 170, 1.0, -1.0)
    course = replace(
        plain,
        time=0.1 * np.arange(200.0),
        step=np.full(200, 0.1),
        measured={"pressure": swept},
        smooth={},
        direction=came,
        halts=(slice(18, 175),),
    )
    np.testing.assert_array_equal(directions(MODEL, course, 0), came)
    turning = replace(MODEL, at_rest=AtRest.INFLATING, rests={0: 0.3}, stiction=0.1)
    signs = directions(turning, course, 0)
    # Half the way is 3 kPa.
    np.testing.assert_allclose(signs[:61], 1.0)
    np.testing.assert_allclose(signs[62:170], -1.0)
    np.testing.assert_allclose(signs[170:], -1.0)
    again = replace(course, direction=np.abs(came))
    np.testing.assert_allclose(directions(turning, again, 0)[175:], 1.0)


def test_where_it_rests_it_may_fade() -> None:
    plain = _courses(recording())["d"]
    # At rest from the start, on the way from 1 s on, and at rest again from 3 s on.
    time = 0.1 * np.arange(60.0)
    rest = np.where(time < 1.0, time, np.maximum(time - 3.0, 0.0))
    course = replace(
        plain,
        time=time,
        step=np.full(60, 0.1),
        measured={},
        smooth={},
        direction=np.where(time < 1.0, 0.0, -1.0),
        rested=rest,
    )
    fading = replace(MODEL, fading=0.5, rests={0: 0.8})
    signs = directions(fading, course, 0)
    np.testing.assert_allclose(signs[:10], 0.8 * np.exp(-2.0 * time[:10]))
    np.testing.assert_allclose(signs[10:31], -1.0)
    np.testing.assert_allclose(signs[35], -np.exp(-1.0))
    np.testing.assert_allclose(signs[50], -np.exp(-4.0))


def test_what_turns_with_the_pressure_fades_once_that_stands() -> None:
    plain = _courses(recording())["b"]
    time = 0.1 * np.arange(60.0)
    course = replace(
        plain,
        time=time,
        step=np.full(60, 0.1),
        measured={"pressure": np.interp(time, [0.0, 2.0, 3.0], [4e5, 4e5, 3e5])},
        smooth={},
        direction=0.0 * time,
        rested=time,
        stood=np.where(time < 2.0, time, np.maximum(time - 3.0, 0.0)),
    )
    turning = replace(MODEL, at_rest=AtRest.INFLATING, fading=0.5, rests={0: 0.8})
    signs = directions(turning, course, 0)
    np.testing.assert_allclose(signs[:20], 0.8 * np.exp(-2.0 * time[:20]))
    # By 6 kPa of 100 it has turned.
    np.testing.assert_allclose(signs[21:31], -1.0)
    np.testing.assert_allclose(signs[35], -np.exp(-1.0))


def test_what_a_frame_holds_that_yields_turns_over_its_way() -> None:
    plain = _courses(recording())["b"]
    # Up by 5 um a metre each sample, to 500, and back.
    way = 5e-6 * np.append(np.arange(0.0, 100.0), np.arange(100.0, 0.0, -1.0))
    course = replace(
        plain,
        time=0.1 * np.arange(200.0),
        step=np.full(200, 0.1),
        measured={"pressure": 1e8 * way},
        smooth={"contraction": Smooth(0.08 + way, 0.0 * way)},
        direction=0.0 * way,
        yields=True,
    )
    turning = replace(
        MODEL, at_rest=AtRest.INFLATING, winding=1e-4, rests={0: 0.0}, stiction=0.1
    )
    signs = directions(turning, course, 0)
    np.testing.assert_allclose(signs[[0, 10]], [0.0, 0.55])
    np.testing.assert_allclose(signs[20:101], 1.1)
    np.testing.assert_allclose(signs[[120, 130]], [0.0, -0.55], atol=1e-9)
    np.testing.assert_allclose(signs[140:], -1.1)
    still = replace(course, yields=False)
    assert directions(turning, still, 0)[120] == pytest.approx(-1.1)


@pytest.mark.parametrize(
    "change",
    [
        {"rests": {0: -0.6}}, {"winding": 2e-4}, {"fading": 3.0}, {"stiction": 0.3},
        {"at_rest": AtRest.YIELDING}, {"winding": 0.0},
    ],
    ids=str,
)  # fmt: skip
def test_a_way_that_was_told_is_told_anew_once_anything_changes(
    change: dict[str, Any],
) -> None:
    plain = _courses(recording())["b"]
    way = 5e-6 * np.append(np.arange(0.0, 100.0), np.arange(100.0, 0.0, -1.0))
    course = replace(
        plain,
        measured={"pressure": 1e9 * way},
        smooth={"contraction": Smooth(0.08 + way, 0.0 * way)},
        time=0.1 * np.arange(200.0),
        direction=0.0 * way,
        rested=0.01 * np.arange(200.0),
        stood=0.01 * np.arange(200.0),
        yields="at_rest" not in change,
    )
    before = replace(
        MODEL, at_rest=AtRest.INFLATING, winding=1e-4, rests={0: 0.4}, fading=9.0
    )
    first = directions(before, course, 0)
    told = directions(replace(before, **change), course, 0)
    alone = directions(replace(before, **change), replace(course), 0)
    np.testing.assert_array_equal(told, alone)
    assert not np.array_equal(told, first)
    np.testing.assert_array_equal(directions(before, course, 0), first)


def test_a_regulator_that_vents_comes_to_its_line_by_and_by() -> None:
    plain = _courses(recording())["b"]
    off = replace(MODEL, regulator=replace(REGULATOR, pressure_low=4e3))
    line = track_of(off, plain, 0).command
    vented = track_of(replace(off, vents=0.0), plain, 0).command
    asked = 500e3 * (plain.column("current") - 4e-3) / 16e-3
    assert (asked.min(), vented.min()) == (0.0, 0.0)
    high = asked > 100e3
    np.testing.assert_allclose(vented[high], line[high])
    assert np.all(np.diff(vented[:50]) > 0)


def test_where_there_was_travel_its_direction_counts() -> None:
    course = _courses(recording())["d"]
    for convention in AtRest:
        signs = directions(replace(MODEL, at_rest=convention), course, 0)
        assert set(signs[5:45]) == {1.0}
        assert set(signs[56:]) == {-1.0}


def test_the_clock_of_what_happened_begins_with_the_recording() -> None:
    plain = recording()
    late = altered(plain, moments(), "time", lambda time: time + 1.7e9)
    for one, other in zip(courses(late, 0.25)[0], courses(plain, 0.25)[0], strict=True):
        told, known = (track_of(MODEL, course, 0).time for course in (one, other))
        np.testing.assert_allclose(told, known, atol=1e-5)
    assert track_of(MODEL, one, 0).time[0] > 0.0


def test_a_leak_is_told_where_the_valve_may_be_shut(silent: dict[str, Course]) -> None:
    waits = np.linspace(0.0, 5.0, len(silent["b"]))
    told = track_of(MODEL, replace(silent["b"], waiting=waits), 0)
    np.testing.assert_array_equal(told.waiting, waits)


def test_how_it_came_to_rest_is_told_of_sweeps_without_travel_alone(
    silent: dict[str, Course],
) -> None:
    model = replace(MODEL, rests={0: 0.3, 1: -0.7})
    came = {run: track_of(model, silent[run], 1).came for run in ("b", "d")}
    np.testing.assert_array_equal(came["b"], -0.7)
    assert np.isnan(came["d"]).all()
    assert np.isnan(track_of(model, silent["b"], 2).came).all()
