from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.noise.smoothing import Smooth
from gripperd.diagnose.readings.course import Course
from gripperd.diagnose.readings.cutting import courses
from gripperd.diagnose.readings.fault import Mask
from gripperd.diagnose.readings.recording import Recording
from gripperd.diagnose.residuals.usable import usable
from gripperd.model.effect import Signal
from gripperd.model.track import Array
from tests.diagnose.held import COMPLIANCE, SIZE, held
from tests.diagnose.small import (
    REGULATOR,
    recording,
    with_jaws,
)
from tests.diagnose.sweep import noise, run, triangle


def _courses(told: Recording) -> dict[str, Course]:
    return {course.run: course for course in courses(told, 0.25)[0]}


@pytest.fixture(scope="module")
def silent() -> dict[str, Course]:
    """The small rig with sensors that hardly make a noise."""
    return _courses(with_jaws(recording(noise=1e-3)))


def test_samples_next_to_a_reversal_say_nothing_of_the_force(
    silent: dict[str, Course],
) -> None:
    bad = np.flatnonzero(~usable(silent["d"], Signal.FORCE))
    turn = int(np.flatnonzero(np.diff(silent["d"].direction) < -1)[0])
    assert turn in bad
    assert bad[bad > 10].tolist() == list(range(turn - 2, turn + 4))


def test_what_is_done_with_what_was_told_is_not_told_again(
    silent: dict[str, Course],
) -> None:
    first = usable(silent["d"], Signal.FORCE)
    kept = first.copy()
    first[:] = False
    np.testing.assert_array_equal(usable(silent["d"], Signal.FORCE), kept)
    assert not np.array_equal(usable(silent["d"], Signal.PRESSURE), kept)


def test_while_a_round_turn_goes_on_the_way_of_friction_is_not_known() -> None:
    time = np.arange(0.0, 28.0, 0.04)
    way = 0.05 * (1 - np.cos(2 * np.pi * time / 28.0))
    told = run(
        contraction=way + noise(time.size, 4e-4),
        pressure=np.full(time.size, 3e5),
        force=np.full(time.size, 500.0),
    )
    (course,) = courses(Recording("r", "0", (told,)), 0.25)[0]
    good = usable(course, Signal.FORCE)
    # 6e-4 of 10 % are gone 0.7 s after the turn.
    near = np.abs(time - 14.0)
    assert not good[near < 0.4].any()
    assert good[(near > 1.2) & (time > 2)].all()


@pytest.mark.parametrize("seed", [0, 1, 2, 3, 7])
def test_a_way_that_may_have_been_gone_says_nothing_of_the_force(seed: int) -> None:
    """A muscle is stretched by 0.7 %, read with 0.09 %, before it contracts.

    The noise of three hides a way that the trend goes, of two it hides even that.
    """
    time = np.arange(0.0, 12.0, 0.1)
    way = np.interp(time, [0, 4.0, 4.7, 4.8, 6.3, 12], [0, 0, -7e-3, -4e-3, 0.19, 0.19])
    told = run(
        contraction=way + noise(time.size, 9e-4, seed, 0.3),
        pressure=np.full(time.size, 3e5),
        force=np.full(time.size, 500.0),
    )
    (course,) = courses(Recording("r", "0", (told,)), 0.25)[0]
    good = usable(course, Signal.FORCE)
    assert good[(time > 1) & (time < 3.5)].mean() > 0.8
    assert not good[43:48].any()


@pytest.mark.parametrize("compliance", [COMPLIANCE, 0.0])
def test_while_friction_turns_round_in_a_frame_that_yields_nobody_knows_its_way(
    compliance: float,
) -> None:
    for course in courses(held(compliance), 0.25)[0]:
        good = usable(course, Signal.FORCE)
        turn, sample = SIZE // 2, 2 * compliance * 1e3 / SIZE
        assert good[turn - 10 : turn - 3].all()
        # Until 3e-4 are undone; a rigid frame turns nothing round.
        until = turn + round(3e-4 / sample) if sample else turn
        assert not good[turn + 2 : until - 2].any()
        assert good[until + 4 :].all()


@pytest.mark.parametrize(
    ("given", "known_from"),
    [
        pytest.param(0.0, 301, id="a stone: when it is let go"),
        # 5e-3 of contraction in 100 samples: 1.5e-3 are gone after 30.
        pytest.param(0.005, 230, id="a sponge: when it has given way"),
    ],
)
def test_jaws_that_hold_on_say_nothing_of_the_force_until_they_follow_the_pressure(
    given: float, known_from: int
) -> None:
    # They meet an object at 100 and leave it at 300; the pressure turns at 200.
    knots = [0, 100, 200, 300, 400]
    sample = np.arange(401)
    told = run(
        pressure=np.interp(sample, knots, [0, 3e5, 5e5, 3e5, 0]) + noise(401, 300.0),
        contraction=np.interp(sample, knots, [0, 0.1, 0.1 + given, 0.1, 0]),
        grip=np.interp(sample, knots, [0, 0, 60, 0, 0]) + noise(401, 0.1, 3),
        force=np.interp(sample, knots, [0, 300, 600, 300, 0]) + noise(401, 1.0, 4),
    )
    (course,) = courses(Recording("r", "0", (told,)), 0.25)[0]
    good = usable(course, Signal.FORCE)
    assert good[110:195].all()
    assert not good[210 : known_from - 8].any()
    assert good[known_from + 8 : 390].all()


def _without_jaws(pressure: Array, way: Array) -> Mask:
    """Samples that count of the force, where nothing is told of any jaws."""
    size = pressure.size
    told = run(
        pressure=pressure + noise(size, 300.0),
        contraction=way + noise(size, 1e-5, 2),
        force=1e-3 * pressure + noise(size, 1.0, 4),
    )
    (course,) = courses(Recording("r", "0", (told,)), 0.25)[0]
    return usable(course, Signal.FORCE)


@pytest.mark.parametrize(
    ("low", "to", "unknown_to", "known_from"),
    [
        pytest.param(100e3, 0.03, 250, 250, id="it follows"),
        pytest.param(100e3, 0.16, 210, 210, id="it goes on"),
        # From 50 kPa on friction has turned round, even if nothing follows.
        pytest.param(100e3, 0.1, 222, 228, id="it is held"),
        pytest.param(480e3, 0.03, 210, 210, id="an isobar that is not quite one"),
    ],
)
def test_a_free_muscle_sticks_until_it_follows_a_pressure_that_has_turned(
    low: float, to: float, unknown_to: int, known_from: int
) -> None:
    """No jaws hold anything: what does not follow at all a machine holds or moves."""
    sample = np.arange(401)
    pressure = np.interp(sample, [0, 200, 400], [2 * low - 500e3, 500e3, low])
    way = np.interp(sample, [0, 200, 260, 400], [0, 0.1, 0.1, to])
    good = _without_jaws(pressure, way)
    assert good[20:195].all()
    assert not good[210:unknown_to].any()
    assert good[known_from:250].all()
    assert good[280:390].all()


@pytest.mark.parametrize(
    ("sag", "follows", "counts"),
    [
        pytest.param(np.linspace(0.0, 40e3, 301), 0.0, False, id="it sticks"),
        pytest.param(np.linspace(0.0, 40e3, 301), -0.1, True, id="it follows"),
        pytest.param(np.linspace(0.0, 8e3, 301), 0.0, True, id="it swings"),
        pytest.param(
            np.append(np.linspace(0.0, 15e3, 11), np.full(290, 15e3)), 0.0, True,
            id="an overshoot",
        ),
    ],
)  # fmt: skip
def test_a_free_muscle_sticks_while_its_pressure_sags(
    sag: Array, follows: float, *, counts: bool
) -> None:
    pressure = np.append(np.linspace(50e3, 500e3, 100), 500e3 - sag)
    way = np.append(np.linspace(0.0, 0.15, 100), 0.15 + follows * sag / 40e3)
    good = _without_jaws(pressure, way)
    assert good[20:90].all()
    assert (good[180:390] == counts).all()


@pytest.mark.parametrize(
    ("again", "counts"),
    [
        # 100 kPa turned its friction round at first.
        pytest.param(60e3, False, id="it sticks"),
        pytest.param(240e3, True, id="a machine holds it"),
    ],
)
def test_a_free_muscle_sticks_though_the_pressure_turns_again_before_it_follows(
    again: float, *, counts: bool
) -> None:
    sample = np.arange(601)
    knots = [0, 200, 300, 400, 500, 600]
    low = 300e3
    pressure = np.interp(sample, knots, [100e3, 500e3, low, low + again, low, 100e3])
    ways = [0, 0.1, 0.1, 0.06, 0.06, 0.06, 0.0]
    way = np.interp(sample, [0, 200, 250, 300, 500, 510, 600], ways)
    good = _without_jaws(pressure, way)
    assert good[20:195].all()
    assert not good[310:340].any()
    assert (good[385:395] == counts).all()


@pytest.mark.parametrize(
    ("to", "counts"),
    [
        pytest.param(0.1, False, id="it follows"),
        pytest.param(-0.1, True, id="a machine pulls it out"),
        pytest.param(0.0, True, id="it is held"),
    ],
)
def test_where_a_sweep_begins_nobody_knows_how_a_free_muscle_sticks(
    to: float, *, counts: bool
) -> None:
    sample = np.arange(401)
    pressure = np.linspace(100e3, 500e3, 401)
    good = _without_jaws(pressure, np.interp(sample, [0, 100, 400], [0, 0, to]))
    assert (good[20:90] == counts).all()
    # 1.5e-3 of contraction are gone after 5 samples.
    assert good[115:390].all()


def test_a_free_muscle_sticks_while_its_pressure_stands_on_a_stair() -> None:
    sample = np.arange(401)
    knots = [0, 100, 120, 250, 270, 400]
    pressure = np.interp(sample, knots, [50e3, 500e3, 400e3, 400e3, 200e3, 200e3])
    way = np.interp(sample, [0, 100, 250, 270, 400], [0.0, 0.15, 0.15, 0.05, 0.05])
    good = _without_jaws(pressure, way)
    assert good[20:90].all()
    assert not good[105:250].any()
    assert good[280:390].all()


def test_a_free_muscle_sticks_behind_a_step_it_does_not_follow() -> None:
    sample = np.arange(401)
    pressure = np.interp(sample, [0, 100, 200], [50e3, 500e3, 60e3])
    pressure[300:] = 100e3
    way = np.interp(sample, [0, 100, 115, 200], [0.0, 0.15, 0.15, 0.0])
    good = _without_jaws(pressure, way)
    assert good[20:90].all()
    assert good[220:290].all()
    assert not good[310:390].any()


def test_what_moves_when_the_pressure_has_long_stood_still_a_machine_moves() -> None:
    sample = np.arange(601)
    pressure = np.interp(sample, [0, 100, 600], [50e3, 500e3, 500e3])
    good = _without_jaws(pressure, np.interp(sample, [0, 400, 600], [0, 0, 0.1]))
    assert good[20:95].all()
    assert good[110:380].all()


@pytest.mark.parametrize(("missing", "counts"), [(3, True), (40, False)])
def test_amid_missing_pressures_nobody_knows_what_there_was(
    missing: int, *, counts: bool
) -> None:
    pressure = triangle(401) + noise(401, 300.0)
    force = 1e-3 * pressure + noise(401, 1.0, 4)
    pressure[100 : 100 + missing] = np.nan
    told = run(pressure=pressure, contraction=np.full(401, 0.1), force=force)
    (course,) = courses(Recording("r", "0", (told,)), 0.25)[0]
    good = usable(course, Signal.FORCE)
    assert (good[100 : 100 + missing] == counts).all()
    assert good[20:98].all()
    assert good[102 + missing : 190].all()


@pytest.mark.parametrize(
    ("grip", "pressure"),
    [
        pytest.param(0.3, triangle(401), id="a grip cell that is off holds nothing"),
        pytest.param(
            np.append(np.zeros(50), np.full(351, 60.0)),
            np.append(np.linspace(50e3, 300e3, 51), np.full(350, 291e3)),
            id="an overshoot turns no load",
        ),
        pytest.param(
            np.append(np.full(400, 60.0), 0.0), np.linspace(50e3, 500e3, 401),
            id="the first rise is no turn",
        ),
    ],
)  # fmt: skip
def test_a_force_counts_while_nothing_holds_the_muscle_back(
    grip: float | Array, pressure: Array
) -> None:
    told = run(
        grip=grip + noise(401, 0.03),
        pressure=pressure + noise(401, 300.0, 2),
        contraction=np.full(401, 0.1),
        force=1e-3 * pressure + noise(401, 1.0, 3),
    )
    (course,) = courses(Recording("r", "0", (told,)), 0.25)[0]
    good = usable(course, Signal.FORCE)
    assert good[60:195].all()
    assert good[210:].all()


def test_samples_next_to_a_step_of_pressure_are_left_out() -> None:
    step = np.where(np.arange(100) < 50, 0.006, 0.012)
    told = run(current=step, pressure=REGULATOR.gain * (step - 0.004))
    (course,) = courses(Recording("r", "0", (told,)), 0.25)[0]
    good = usable(course, Signal.PRESSURE)
    assert not good[48:53].any()
    assert good[:45].all()
    assert good[55:].all()


@pytest.mark.parametrize(
    ("away", "time", "left_out"),
    [
        pytest.param(20e3, 0.2, 8, id="a valve on its way"),
        pytest.param(20e3, 60.0, 0, id="a leak"),
        pytest.param(0.0, 0.2, 0, id="at rest"),
    ],
)
def test_a_pressure_that_comes_to_rest_as_a_sweep_begins_tells_nothing(
    away: float, time: float, left_out: int
) -> None:
    """Its command went before the record began; then it ramps."""
    clock = 0.04 * np.arange(400.0)
    current = 0.012 + 0.0005 * np.maximum(clock - 4.0, 0.0)
    settled = REGULATOR.gain * (current - 0.004)
    pressure = settled - away * np.exp(-clock / time) + noise(400, 0.5e3)
    told = run(current=current, pressure=pressure, time=clock)
    (course,) = courses(Recording("r", "0", (told,)), 0.25)[0]
    good = usable(course, Signal.PRESSURE)
    assert not good[:left_out].any()
    assert good[2 * left_out + 10 :].all()
    assert good.all() == (left_out == 0)


@pytest.mark.parametrize(
    ("before", "left_out"),
    [
        pytest.param(240e3, 16, id="it was at 240 kPa"),
        pytest.param(0.0, 0, id="it was at rest"),
    ],
)
def test_a_pressure_that_comes_to_a_ramp_as_a_sweep_begins_tells_nothing(
    before: float, left_out: int
) -> None:
    """Its command went back right before the record began, and ramps at once."""
    clock = 0.05 * np.arange(400.0)
    current = 0.004 + 0.0005 * clock
    settled = REGULATOR.gain * (current - 0.004)
    pressure = settled + before * np.exp(-clock / 0.4) + noise(400, 0.5e3)
    told = run(current=current, pressure=pressure, time=clock)
    (course,) = courses(Recording("r", "0", (told,)), 0.25)[0]
    good = usable(course, Signal.PRESSURE)
    assert not good[:left_out].any()
    assert good[2 * left_out + 10 :].all()
    assert good.all() == (left_out == 0)


def test_a_slow_ramp_of_pressure_is_usable() -> None:
    course = _courses(recording())["a"]
    assert usable(course, Signal.PRESSURE).all()


def _turned(period: int, way: float = 0.0) -> Mask:
    """Force samples that count of triangles of 280 kPa that turn between readings."""
    phase = (np.arange(400) + 0.5) % period
    there = np.minimum(phase, period - phase) / (period / 2)
    pressure = 60e3 + 280e3 * there
    told = run(
        pressure=pressure + noise(400, 300.0),
        contraction=np.linspace(0.0, way, 400),
        force=1e-3 * pressure + noise(400, 1.0, 4),
    )
    (course,) = courses(Recording("r", "0", (told,)), 0.25)[0]
    return usable(course, Signal.FORCE)


def test_at_a_turn_that_lies_between_two_readings_nobody_knows_how_far_it_went() -> (
    None
):
    good = _turned(40)
    # The second reading beside each turn has it behind it.
    told = np.ones(400, dtype=bool)
    told[20::20] = False
    np.testing.assert_array_equal(good, told)


def test_until_a_pressure_has_gone_back_nobody_knows_how_friction_turned_round() -> (
    None
):
    # By 1.4 kPa from one reading to the next, 6 kPa are five of them.
    good = _turned(400)
    assert not good[200:205].any()
    assert good[20:199].all()
    assert good[206:380].all()


def _led(*corners: tuple[float, float], loud: float = 300.0) -> Mask:
    """Force samples that count while a pressure is led from corner to corner. [kPa]."""
    places, kilopascals = zip(*corners, strict=True)
    pressure = 1e3 * np.interp(np.arange(400), places, kilopascals)
    told = run(
        pressure=pressure + noise(400, loud),
        contraction=np.full(400, 0.1),
        force=1e-3 * pressure + noise(400, 1.0, 4),
    )
    (course,) = courses(Recording("r", "0", (told,)), 0.25)[0]
    return usable(course, Signal.FORCE)


def test_a_pressure_that_stands_turns_no_friction() -> None:
    good = _led((0, 60), (100, 340), (250, 340), (350, 60), (400, 60))
    assert good[105:245].all()
    assert not good[251:253].any()
    assert good[255:345].all()


def test_in_a_halt_nobody_knows_how_friction_turned_round_either() -> None:
    # There in 50 samples; 2.8 kPa from one reading to the next, and 6 of them are two.
    pressure = np.interp(np.arange(400), [60, 200, 340], [60e3, 452e3, 60e3])
    told = run(
        pressure=pressure + noise(400, 300.0),
        contraction=np.interp(np.arange(400), [0, 50], [0.0, 0.1]),
        force=1e-3 * pressure + noise(400, 1.0, 4),
    )
    (course,) = courses(Recording("r", "0", (told,)), 0.25)[0]
    good = usable(course, Signal.FORCE)
    assert not good[200:202].any()
    assert good[65:199].all()
    assert good[204:330].all()


def test_a_pressure_that_creeps_back_may_turn_friction() -> None:
    """By 4 kPa, which its trend knows well; then it falls on."""
    good = _led((0, 60), (100, 340), (250, 336), (350, 60), (400, 60))
    assert good[20:98].all()
    assert not good[140:250].any()
    assert good[260:345].all()


def test_what_is_badly_known_does_not_stand_for_that() -> None:
    """A slow way back of which noise hides the first 3 kPa; a fifth of 6 may stand."""
    good = _led((0, 60), (100, 340), (350, 310), (400, 310), loud=3000.0)
    assert not good[115:140].any()


@pytest.mark.parametrize(("stood", "known"), [(0, True), (100, False)])
def test_of_a_pressure_that_stood_nobody_knows_which_way_it_came(
    stood: int,
    known: bool,
) -> None:
    good = _led((0, 300), (stood, 300), (300, 340), (399, 340))
    setting_out = good[stood + 5 : stood + 20]
    assert setting_out.all() if known else not setting_out.any()
    assert good[stood + 60 : 290].all()
    assert good[2 : stood - 5].all()


def test_where_a_machine_moves_the_muscle_its_way_turns_friction() -> None:
    good = _turned(40, 0.3)
    # At the third turn and the next, nothing sticks any more.
    assert good[50:75].all()
    assert good[80:110].all()


def test_jaws_without_an_object_say_nothing_of_the_grip() -> None:
    grip = np.where(np.arange(100) < 50, 0.2, 20.0)
    told = run(
        grip=grip,
        force=np.full(100, 400.0) + noise(100, 1.0),
        contraction=np.full(100, 0.1) + noise(100, 1e-4, 2),
    )
    (course,) = courses(Recording("r", "0", (told,)), 0.25)[0]
    # The leap of this grip is none of its noise.
    smooth = {**course.smooth, "grip": course.smooth["grip"]._replace(variance=0.01)}
    good = usable(replace(course, smooth=smooth), Signal.GRIP)
    np.testing.assert_array_equal(good, grip > 10)


def test_a_missing_reading_is_not_usable() -> None:
    gap = triangle(100)
    gap[30:33] = np.nan
    told = run(force=gap, pressure=triangle(100), contraction=np.full(100, 0.1))
    (course,) = courses(Recording("r", "0", (told,)), 0.25)[0]
    assert not usable(course, Signal.FORCE)[30:33].any()


_AWAY = np.abs(np.arange(400) - 202) > 6
"""Samples of a triangle away from its turn. [-]"""


def _ramped(cut: float) -> Course:
    """Up and down at a fixed length; the smooth pressure lies off near the top."""
    pressure = triangle()
    told = run(
        pressure=pressure + noise(400, 1e3, 1),
        contraction=np.full(400, 0.1),
        force=2e-3 * pressure + noise(400, 4.0),
    )
    (course,) = courses(Recording("r", "0", (told,)), 0.25)[0]
    near = np.abs(np.arange(400) - 199.5) < 5
    known = Smooth(pressure - cut * near, np.gradient(pressure), variance=1e6)
    return replace(course, smooth={**course.smooth, "pressure": known})


def test_samples_where_the_smooth_pressure_cuts_a_corner_are_left_out() -> None:
    bad = np.flatnonzero(~usable(_ramped(3e3), Signal.FORCE))
    assert {*range(196, 204)} <= {*bad}
    assert bad[0] >= 190
    assert bad[-1] < 210


def test_noise_about_a_smooth_pressure_is_no_cut_corner() -> None:
    assert usable(_ramped(0.0), Signal.FORCE)[_AWAY].all()


def test_on_stairs_each_corner_that_the_smooth_pressure_cuts_is_left_out() -> None:
    plain = _ramped(0.0)
    # Off to either side in turn: five neighbours on the average by nothing.
    off = np.zeros(400)
    off[60:80] = 5e3 * (-1.0) ** np.arange(20)
    known = plain.smooth["pressure"]
    smooth = {**plain.smooth, "pressure": known._replace(value=known.value + off)}
    cut = replace(plain, smooth=smooth)
    assert usable(cut, Signal.FORCE)[60:80].any()
    good = usable(replace(cut, on_stairs=True), Signal.FORCE)
    assert not good[60:80].any()
    assert np.mean(good) > 0.9


def test_a_smooth_pressure_is_never_held_to_less_than_its_transmitter_is_good_for() -> (
    None
):
    course = _ramped(0.0)
    top = float(course.column("pressure").max())
    for share, whole in ((5e-4, True), (2e-3, False)):
        # What was filled in between two readings has no noise to speak of.
        off = course.column("pressure") + share * top
        known = Smooth(off, np.gradient(off), variance=9.0)
        filled = replace(course, smooth={**course.smooth, "pressure": known})
        assert usable(filled, Signal.FORCE)[_AWAY].all() == whole


def test_a_smooth_force_that_cuts_a_corner_costs_no_grip() -> None:
    force = 600.0 + noise(200, 1.0)
    told = run(grip=np.full(200, 90.0), force=force, contraction=np.full(200, 0.1))
    (course,) = courses(Recording("r", "0", (told,)), 0.25)[0]
    level = np.full(200, 600.0)
    level[100:105] -= 5.0
    smooth = {**course.smooth, "force": Smooth(level, 0 * level, variance=1.0)}
    # Joints under a steady load never come loose, and readings are compared.
    assert usable(replace(course, smooth=smooth), Signal.GRIP).all()


def test_a_grip_without_a_reading_of_the_force_is_not_usable() -> None:
    force = 600.0 + noise(200, 1.0)
    force[50:53] = np.nan
    told = run(grip=np.full(200, 90.0), force=force, contraction=np.full(200, 0.1))
    (course,) = courses(Recording("r", "0", (told,)), 0.25)[0]
    assert np.isfinite(course.level("force")).all()
    bad = np.flatnonzero(~usable(course, Signal.GRIP))
    assert bad.tolist() == [50, 51, 52]


def test_while_friction_turns_round_the_grip_says_nothing() -> None:
    # Joints stick within 30 of 500 N, and are loose again when 59.4 N are undone.
    force = 300.0 + 500.0 * (1.0 - np.abs(np.linspace(-1.0, 1.0, 401)))
    told = run(grip=force / 4, force=force, contraction=np.full(401, 0.1))
    (course,) = courses(Recording("r", "0", (told,)), 0.25)[0]
    smooth = {**course.smooth, "force": Smooth(force, np.gradient(force))}
    bad = np.flatnonzero(~usable(replace(course, smooth=smooth), Signal.GRIP))
    # 2.5 N a sample: 29.4 N at the start, 59.4 N after the top, two samples beside.
    assert bad.tolist() == [*range(14), *range(199, 226)]


@pytest.mark.parametrize(("back", "unsure"), [(25.0, False), (35.0, True)])
def test_nor_does_it_where_friction_may_have_turned_and_come_back(
    back: float, *, unsure: bool
) -> None:
    # Joints stick within 30 of 500 N: more than that back may have turned them round.
    corners = [300.0, 800.0, 800.0 - back, 800.0, 300.0]
    way = np.cumsum([0.0, *np.abs(np.diff(corners))])
    force = np.interp(np.arange(0.0, way[-1], 2.5), way, corners)
    told = run(grip=force / 4, force=force, contraction=np.full(force.size, 0.1))
    (course,) = courses(Recording("r", "0", (told,)), 0.25)[0]
    smooth = {**course.smooth, "force": Smooth(force, np.gradient(force))}
    good = usable(replace(course, smooth=smooth), Signal.GRIP)
    dip = slice(203, 200 + round(2 * back / 2.5) - 3)
    assert np.all(good[dip] != unsure)
    assert good[100:198].all()


def test_until_joints_have_come_loose_the_grip_says_nothing() -> None:
    force = np.linspace(300.0, 800.0, 201)
    told = run(grip=force / 4, force=force, contraction=np.full(201, 0.1))
    (course,) = courses(Recording("r", "0", (told,)), 0.25)[0]
    smooth = {**course.smooth, "force": Smooth(force, np.gradient(force))}
    bad = np.flatnonzero(~usable(replace(course, smooth=smooth), Signal.GRIP))
    # 2.5 N a sample: 29.4 N, and two samples beside.
    assert bad.tolist() == list(range(14))


def test_where_the_way_turns_round_but_not_the_load_the_grip_says_nothing() -> None:
    """Joints may rub as they came, and nobody knows where in a dwell they turn."""
    force = np.linspace(300.0, 800.0, 401)
    way = 0.1 + 0.05 * (1.0 - np.abs(np.linspace(-1.0, 1.0, 401)))
    told = run(grip=force / 4, force=force, contraction=way)
    (course,) = courses(Recording("r", "0", (told,)), 0.25)[0]
    smooth = {**course.smooth, "force": Smooth(force, np.gradient(force))}
    bad = np.flatnonzero(~usable(replace(course, smooth=smooth), Signal.GRIP))
    turn = int(np.flatnonzero(np.diff(course.direction) < -1)[0]) + 1
    assert bad[bad > 50].tolist() == list(range(turn, turn + 3))
