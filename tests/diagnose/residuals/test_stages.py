from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.noise.smoothing import Smooth
from gripperd.diagnose.readings.course import Course
from gripperd.diagnose.readings.cutting import courses
from gripperd.diagnose.readings.recording import Recording
from gripperd.diagnose.residuals.explanation import AtRest, Explanation
from gripperd.diagnose.residuals.stages import passed_on, predictable, predicted
from gripperd.diagnose.residuals.track import track_of
from gripperd.diagnose.residuals.usable import usable
from gripperd.effects.braid_friction import BraidFriction
from gripperd.effects.channel_delay import ChannelDelay
from gripperd.effects.coulomb_friction import CoulombFriction
from gripperd.effects.force_sensor_bias import ForceSensorBias
from gripperd.effects.force_sensor_gain import ForceSensorGain
from gripperd.effects.linkage_friction import LinkageFriction, Turning
from gripperd.effects.pressure_sensor_bias import PressureSensorBias
from gripperd.effects.series_compliance import SeriesCompliance
from gripperd.effects.viscous_friction import ViscousFriction
from gripperd.model.effect import Signal
from gripperd.model.track import Array
from tests.diagnose.small import (
    LINKAGE,
    MODEL,
    MUSCLE,
    moments,
    recording,
    textbook,
    with_jaws,
    without,
)
from tests.diagnose.sweep import noise, run

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
    good = usable(silent[name], Signal.FORCE)
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


STAIRS = np.linspace(0.0, 49.8, 250)
"""Times of a grip up a staircase. [s]"""


def _grasping(late: float, delay: float, skew: float = 0.0) -> Array:
    """What is left of a grip when a cell that reads late is taken to be so late.

    A smooth force smears the steps: 40 N of grip in two samples.
    """
    stairs = 300.0 + 160.0 * np.floor(STAIRS / 5)
    pull = np.interp(STAIRS, STAIRS[::2], stairs[::2])
    read = np.interp(STAIRS - late, STAIRS, pull) + noise(250, 8.0)
    grip = (pull - 240.0 - 1000.0 * 0.25 * 0.08) / 4
    held = np.full(250, 0.08)
    told = run(time=STAIRS, pressure=pull, contraction=held, force=read, grip=grip)
    (course,) = courses(Recording("r", "0", (told,)), 0.2)[0]
    aware = JAWED.with_effect(ChannelDelay(delay=delay, channel=Signal.FORCE))
    aware = replace(aware, skews={Signal.GRIP: skew})
    passed = passed_on(JAWED, course, track_of(JAWED, course, 0), Signal.GRIP)
    return (grip - passed - _one(aware, course, Signal.GRIP))[:-2]


def test_a_grip_is_foretold_from_what_a_late_cell_reads_later() -> None:
    # The noise of the cell, of which a ratio of 4 leaves a quarter.
    assert np.std(_grasping(0.4, 0.4)) == pytest.approx(8.0 / 4, rel=0.1)


def test_a_delay_takes_no_noise_off_a_grip() -> None:
    """Halfway between two readings there would be a third less of it."""
    usual = [np.median(np.abs(_grasping(0.0, delay))) for delay in (0.0, 0.08)]
    assert usual[1] == pytest.approx(usual[0], rel=0.1)


@pytest.mark.parametrize("skew", [0.08, -0.08])
def test_nor_does_a_grip_that_is_sampled_beside_a_late_force(skew: float) -> None:
    usual = [np.median(np.abs(_grasping(0.16, 0.16, each))) for each in (0.0, skew)]
    assert usual[1] == pytest.approx(usual[0], rel=0.1)


def test_a_gain_takes_no_noise_off_a_grip() -> None:
    """Nor does one that says that a cell reads a tenth too high."""
    held, pull = np.full(250, 0.08), np.full(250, 600.0)
    told = run(
        time=STAIRS, pressure=pull, contraction=held, force=pull + noise(250, 8.0),
        grip=(pull - 260.0) / 4,
    )  # fmt: skip
    (course,) = courses(Recording("r", "0", (told,)), 0.2)[0]
    passed = passed_on(JAWED, course, track_of(JAWED, course, 0), Signal.GRIP)
    left = [
        np.std(
            told.columns["grip"]
            - passed
            - _one(JAWED.with_effect(ForceSensorGain(error=error)), course, Signal.GRIP)
        )
        for error in (0.0, 0.1)
    ]
    assert left[1] == pytest.approx(left[0], rel=0.01)


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


def test_a_zero_error_is_added_to_the_reading(silent: dict[str, Course]) -> None:
    shifted = replace(MODEL, zeros={Signal.FORCE: 4.0})
    change = _one(shifted, silent["a"], Signal.FORCE) - _one(
        MODEL, silent["a"], Signal.FORCE
    )
    np.testing.assert_allclose(change, 4.0)


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


@pytest.mark.parametrize("way", [1e-7, 3e-4, 2e-3])
def test_friction_inside_a_mount_turns_with_the_way_that_it_stretches(
    silent: dict[str, Course], way: float
) -> None:
    course = silent["b"]
    pull = np.maximum(course.level("force"), 0.0)
    soft = MODEL.with_effect(SeriesCompliance(shortening=way / float(np.ptp(pull))))
    bare = replace(soft, effects=soft.effects[:1] + soft.effects[2:])
    friction = _one(soft, course, Signal.FORCE) - _one(bare, course, Signal.FORCE)
    state = track_of(bare, course, 0).state
    # At its highest the pull turns; half a way down half of the stretch is undone.
    for place, share in ((50, 0.0), (75, 0.5)):
        sign = max(1 - share * way / 4e-4, -1.0)
        full = np.asarray(BraidFriction().magnitude(state, MUSCLE))[place]
        assert friction[place] == pytest.approx(-sign * full, rel=0.15)


def test_the_bladder_may_slide_in_its_braid_where_a_rod_stays(
    silent: dict[str, Course],
) -> None:
    course = silent["b"]
    rubbed = MODEL.with_effect(CoulombFriction(20.0))
    found = {
        sign: _one(replace(rubbed, at_rest=sign, rests={0: 1.0}), course, Signal.FORCE)
        for sign in AtRest
    }
    state = track_of(MODEL, course, 0).state
    braid = np.asarray(BraidFriction().magnitude(state, MUSCLE))
    # On the way back, past the turn, the braid's friction helps, the rod's does not.
    back = slice(60, 95)
    carried = found[AtRest.CARRIED][back]
    np.testing.assert_allclose(found[AtRest.BLADDER][back], carried + 2 * braid[back])
    np.testing.assert_allclose(
        found[AtRest.INFLATING][back], carried + 2 * braid[back] + 2 * 20.0
    )


def test_in_a_mount_the_bladder_goes_the_way_that_it_is_moved(
    silent: dict[str, Course],
) -> None:
    plain = silent["d"]
    # It travels, then is held, and the pressure sinks and rises again.
    places = np.arange(len(plain))
    pressure = np.interp(places, [40, 70, 99], [300e3, 0.0, 300e3])
    course = replace(plain, smooth={}, direction=np.ones(len(plain)), measured={
        "pressure": pressure, "force": pressure / 1e3,
        "contraction": np.minimum(places / 400, 0.1),
    })  # fmt: skip
    soft = MODEL.with_effect(SeriesCompliance(shortening=2e-3 / 300))
    carried, sliding = (
        _one(replace(soft, at_rest=sign), course, Signal.FORCE)
        for sign in (AtRest.CARRIED, AtRest.BLADDER)
    )
    np.testing.assert_array_equal(sliding, carried)


@pytest.mark.parametrize("sign", [AtRest.CARRIED, AtRest.BLADDER])
def test_a_rod_inside_a_mount_turns_with_the_way_that_it_stretches(
    silent: dict[str, Course], sign: AtRest
) -> None:
    course = silent["b"]
    pull = np.maximum(course.level("force"), 0.0)
    soft = MODEL.with_effect(SeriesCompliance(shortening=2e-3 / float(np.ptp(pull))))
    soft = replace(soft, at_rest=sign)
    rubbed = soft.with_effect(CoulombFriction(20.0))
    friction = _one(rubbed, course, Signal.FORCE) - _one(soft, course, Signal.FORCE)
    np.testing.assert_allclose(friction[75:95], 20.0)


def test_friction_inside_a_mount_is_never_more_than_it_is(
    silent: dict[str, Course],
) -> None:
    course = silent["b"]
    # It slips back by half of what turns friction, too little to count as travel.
    slipping = course.level("contraction") - np.linspace(0.0, 4e-4, len(course))
    course = replace(course, smooth={}, measured={
        **course.measured, "contraction": slipping,
    })  # fmt: skip
    soft = MODEL.with_effect(SeriesCompliance(shortening=2e-5))
    both = soft.with_effect(CoulombFriction(20.0))
    friction = _one(both, course, Signal.FORCE) - _one(soft, course, Signal.FORCE)
    assert np.max(np.abs(friction)) == pytest.approx(20.0)


def test_a_muscle_inside_a_mount_has_the_rate_of_the_stretch(
    silent: dict[str, Course],
) -> None:
    course = silent["b"]
    pull = np.maximum(course.level("force"), 0.0)
    way = 2e-3
    soft = MODEL.with_effect(SeriesCompliance(shortening=way / float(np.ptp(pull))))
    damped = soft.with_effect(ViscousFriction(damping=1e4))
    damping = _one(damped, course, Signal.FORCE) - _one(soft, course, Signal.FORCE)
    stretch = way * pull / float(np.ptp(pull))
    for begin, end in ((15, 35), (65, 85)):
        gone = (stretch[end] - stretch[begin]) / (course.time[end] - course.time[begin])
        assert abs(gone) > way / 20.0
        assert np.mean(damping[begin:end]) == pytest.approx(-1e4 * gone, rel=0.1)


def test_a_mount_that_stretches_turns_no_friction_where_the_length_travels(
    silent: dict[str, Course],
) -> None:
    course, stiff = silent["e"], MODEL.with_effect(SeriesCompliance(shortening=1e-9))
    change = _one(stiff, course, Signal.FORCE) - _one(MODEL, course, Signal.FORCE)
    np.testing.assert_allclose(change, 0.0, atol=0.01)


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


def test_smooth_inputs_leave_out_no_more_than_their_noise() -> None:
    course = _courses(recording())["e"]
    track = track_of(MODEL, course, 0)
    left = passed_on(MODEL, course, track, Signal.FORCE)
    # 2e-4 of contraction at 400 kPa, where the pull falls by 5 to 6 kN per unit.
    assert np.std(left) < 2e-4 * 6e3
    assert passed_on(MODEL, course, track, Signal.PRESSURE) == 0.0


def test_the_grip_rubs_the_way_its_load_goes() -> None:
    # A held object: the muscle pulls more and then less, and nothing travels.
    force = 400.0 + 400.0 * (1.0 - np.abs(np.linspace(-1.0, 1.0, 201)))
    told = run(contraction=np.full(201, 0.08), force=force, grip=force / 4)
    (course,) = courses(Recording("r", "0", (told,)), 0.25)[0]
    assert not course.direction.any()
    for by, unloading in ((Turning.LOAD, 1.1), (Turning.TRAVEL, 0.9)):
        rubbing = JAWED.with_effect(LinkageFriction(loss=0.1, by=by))
        share = _one(rubbing, course, Signal.GRIP) / _one(JAWED, course, Signal.GRIP)
        np.testing.assert_allclose(share[20:100], 0.9)
        np.testing.assert_allclose(share[125:], unloading)


@pytest.mark.parametrize(
    ("wanders", "fills"), [(False, 0.0), (True, 0.0), (False, 1e5)]
)
def test_where_a_machine_moves_jaws_the_grip_rubs_the_way_they_go(
    *, wanders: bool, fills: float
) -> None:
    """The muscle pulls less as it shortens: its load goes the other way.

    Not where a reading of jaws on a stiff object but wanders while the load falls, nor
    where a muscle that is filled closes them.
    """
    swing = np.sin(np.linspace(0.0, 4 * np.pi, 400))
    held = 0.06 - 0.04 * swing
    pull = 700.0 + 200.0 * swing
    if wanders:
        held = np.r_[np.linspace(0.0, 0.06, 100), np.full(200, 0.06)]
        held = np.r_[held, np.linspace(0.06, 0.062, 100)]
        pull = np.r_[np.linspace(300.0, 310.0, 100), np.linspace(310.0, 900.0, 200)]
        pull = np.r_[pull, np.linspace(900.0, 500.0, 100)]
    told = run(
        pressure=4e5 + fills * swing + noise(400, 1e3), contraction=held,
        force=pull, grip=(pull - 240.0) / 4,
    )  # fmt: skip
    (course,) = courses(Recording("r", "0", (told,)), 0.25)[0]
    rubbing = JAWED.with_effect(LinkageFriction(loss=0.1))
    share = _one(rubbing, course, Signal.GRIP) / _one(JAWED, course, Signal.GRIP)
    way = np.sign(np.gradient(pull if wanders or fills else held))
    # Friction takes some load to turn round, where way and load turn at once.
    clear = (np.abs(np.gradient(pull)) > (5.0 if fills else 1.0)) & (pull > 400.0)
    assert np.mean(np.abs(share - (1 - 0.1 * way))[clear] < 0.01) > 0.9


def test_a_machine_may_move_jaws_of_a_muscle_that_was_filled_before() -> None:
    """Filled in 100 samples it pulls more, and then less as it is let shorten."""
    filled = np.linspace(0.0, 1.0, 100)
    swing = 0.5 - 0.5 * np.cos(np.linspace(0.0, 4 * np.pi, 400))
    way = np.r_[0.0 * filled, 0.06 * swing]
    pull = np.r_[950.0 * filled, 950.0 - 400.0 * swing]
    told = run(
        pressure=np.r_[4e5 * filled, np.full(400, 4e5)] + noise(500, 1e3),
        contraction=way + noise(500, 1e-4, 2), force=pull, grip=(pull - 240.0) / 4,
    )  # fmt: skip
    (course,) = courses(Recording("r", "0", (told,)), 0.25)[0]
    rubbing = JAWED.with_effect(LinkageFriction(loss=0.1))
    rubbed, free = (_one(model, course, Signal.GRIP) for model in (rubbing, JAWED))
    share = rubbed / np.maximum(free, 1.0)
    np.testing.assert_allclose(share[60:95], 0.9)
    for start, sign in ((100, 1), (200, -1), (300, 1), (400, -1)):
        np.testing.assert_allclose(share[start + 15 : start + 85], 1 - 0.1 * sign)


def _held(size: int = 201) -> tuple[Course, Array]:
    """A grasp read by a noisy force cell, its smooth column off by a cut corner."""
    force = 800.0 - 400.0 * np.abs(np.linspace(-1.0, 1.0, size))
    told = run(
        contraction=np.full(size, 0.08), force=force + noise(size, 4.0), grip=force / 4
    )
    (course,) = courses(Recording("r", "0", (told,)), 0.25)[0]
    cut = force - 12.0 * (np.abs(np.arange(size) - size // 2) < 8)
    smooth = {**course.smooth, "force": Smooth(cut, np.gradient(cut))}
    return replace(course, smooth=smooth), force


@pytest.mark.parametrize(
    ("loss", "rising", "falling"),
    [
        pytest.param(0.0, slice(0, 101), slice(101, 201), id="cut corner"),
        # Loose but for 0.06 of 400 N from the start, and twice that from the top.
        pytest.param(0.1, slice(20, 90), slice(130, 201), id="friction"),
    ],
)
def test_a_grip_is_compared_with_the_force_reading_by_reading(
    loss: float, rising: slice, falling: slice
) -> None:
    course, force = _held()
    rubbing = JAWED.with_effect(LinkageFriction(loss=loss))
    track = track_of(rubbing, course, 0)
    passed = passed_on(rubbing, course, track, Signal.GRIP)
    compared = _one(rubbing, course, Signal.GRIP) + passed
    pull = course.column("force") - 240.0 - 1000.0 * 0.25 * 0.08
    for side, share in ((rising, 1 - loss), (falling, 1 + loss)):
        np.testing.assert_allclose(compared[side], share * pull[side] / 4, rtol=2e-3)
    assert np.abs(course.level("force") - force).max() == pytest.approx(12.0)


def test_a_noisy_force_is_passed_on_to_nothing_but_the_grip() -> None:
    course, _ = _held()
    soft = JAWED.with_effect(SeriesCompliance(compliance=1e-5))
    track = track_of(soft, course, 0)
    sharp = np.std(passed_on(soft, course, track, Signal.OPENING))
    # 4 N would be 4e-5 m; the sharper contraction is a constant here.
    assert sharp < 1e-6


def test_without_a_cell_a_tendon_stretches_by_what_grip_and_spring_take_up() -> None:
    way = np.linspace(0.0, 0.08, 200)
    grip = np.linspace(0.0, 50.0, 200)
    told = run(contraction=way, grip=grip, opening=0.085 - 4 * 0.25 * way)
    (course,) = courses(Recording("r", "0", (told,)), 0.25)[0]
    soft = JAWED.with_effect(SeriesCompliance(compliance=1e-5))
    wider = _one(soft, course, Signal.OPENING) - _one(JAWED, course, Signal.OPENING)
    # The return spring has 240 N and 1000 N/m, the ratio is 4.
    np.testing.assert_allclose(wider, 1e-5 * (240 + 250 * way + 4 * grip), rtol=0.01)


@pytest.mark.parametrize(
    "strokes", [pytest.param(n, id=f"{n} strokes") for n in (0, 1, 4, 12)]
)
def test_an_opening_is_compared_with_the_contraction_reading_by_reading(
    strokes: int,
) -> None:
    way = 0.05 - 0.05 * np.cos(np.linspace(0.0, 2 * np.pi * strokes, 401))
    told = run(contraction=way + noise(401, 5e-4), opening=0.085 - 4 * 0.25 * way)
    (course,) = courses(Recording("r", "0", (told,)), 0.25)[0]
    assert course.direction.any() == (strokes > 0)
    track = track_of(JAWED, course, 0)
    passed = passed_on(JAWED, course, track, Signal.OPENING)
    compared = _one(JAWED, course, Signal.OPENING) + passed
    # The noise of the contraction times four rest lengths, however fast the jaws go.
    off = np.std(compared - course.column("opening"))
    assert off == pytest.approx(4 * 0.25 * 5e-4, rel=0.1)
