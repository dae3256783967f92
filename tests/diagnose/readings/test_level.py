from collections.abc import Sequence

import numpy as np
import pytest

from gripperd.diagnose.noise.smoothing import LEAP, smooth
from gripperd.diagnose.readings.course import Course
from gripperd.diagnose.readings.recording import Run
from gripperd.model.track import Array
from tests.diagnose.cycled import CORNER, SIZE, WAY, cut, cycled
from tests.diagnose.sweep import noise, run, triangle


def test_between_reversals_a_contraction_has_no_wiggle() -> None:
    course = cycled(WAY, 5e-4)
    steps = np.diff(course.level("contraction"))
    assert (steps[: CORNER - 5] >= 0).all()
    assert (steps[CORNER + 5 :] <= 0).all()


def test_a_smoothed_column_is_nearer_to_the_truth() -> None:
    course = cycled(WAY, 5e-4)
    errors = [
        np.std(column - WAY)
        for column in (course.level("contraction"), course.column("contraction"))
    ]
    assert errors[0] < 0.5 * errors[1]


def test_pressure_keeps_the_corner_of_its_command() -> None:
    command = triangle(SIZE, 0.0, 500e3)
    (course,) = cut(
        run(
            current=0.004 + 0.016 * command / 500e3, pressure=command + noise(SIZE, 2e3)
        )
    )
    assert course.level("pressure")[CORNER] == pytest.approx(500e3, abs=1e3)


def test_a_length_that_is_moved_quickly_is_followed() -> None:
    # Steps of 3 % in a tenth of a second, read 40 times a second.
    time = np.arange(0.0, 4.0, 0.025)
    knots = np.array([0.0, 0.5, 0.6, 1.5, 1.6, 2.5, 2.6, 4.0])
    way = np.interp(time, knots, [0.0, 0.0, 0.03, 0.03, 0.06, 0.06, 0.09, 0.09])
    (course,) = cut(run(time=time, contraction=way + noise(time.size, 2e-4)))
    assert np.sqrt(np.mean((course.level("contraction") - way) ** 2)) < 6e-4
    assert np.sqrt(np.mean((course.level("length") - way) ** 2)) < 6e-4


def test_a_length_is_no_less_known_than_each_reading_of_it() -> None:
    """Of noise with a memory a mean is known less well than of noise without."""
    way = triangle(2000, 0.0, 0.15)
    (course,) = cut(run(contraction=way + noise(2000, 1e-3, memory=0.6)))
    wrong = np.std(course.level("length") - way)
    assert wrong < np.max(course.doubt("length")) < 1.1e-3


def test_a_length_that_is_held_has_no_corners() -> None:
    course, *_ = cut(*(
        run(f"{seed}", contraction=0.1 + noise(400, 1e-3, seed, memory=0.8))
        for seed in range(6)
    ))  # fmt: skip
    assert np.ptp(course.level("length")) == 0.0
    assert course.level("length")[0] == course.level("contraction")[0]
    # Three times as loud in a mean over many as in one reading, and 20 times less.
    assert course.doubt("length") == pytest.approx(1e-3 * 3 / 20, rel=0.4)


@pytest.mark.parametrize("half", [5e3, 8e3, 12e3, 20e3])
@pytest.mark.parametrize("came", [-1.0, 0.0, 1.0])
def test_pressure_keeps_the_corners_of_a_dead_band(half: float, came: float) -> None:
    # Ramps of 0.5 s and rests of 2 s, up and down; then rests that tell the noise.
    levels = np.repeat([0.0, 100e3, 200e3, 300e3, 400e3, 300e3, 200e3, 100e3, 0.0], 2)
    knots = np.column_stack([np.arange(9) * 50, np.arange(9) * 50 + 40]).ravel()
    command = 20e3 + np.interp(np.arange(450), knots, levels)
    true, held = [], command[0] - came * half
    for goal in command:
        held = min(max(held, goal - half), goal + half)
        true.append(held)
    rest = np.full(450, 200e3)
    way, *_ = cut(
        _regulated("way", command, np.array(true) + noise(450, 2.4e3, 1, memory=0.5)),
        _regulated("rest", rest, rest + noise(450, 2.4e3, 2, memory=0.5)),
        _regulated("again", rest, rest + noise(450, 2.4e3, 3, memory=0.5)),
    )
    left = way.level("pressure") - true
    assert np.abs(left).max() < 4.5e3
    assert np.std(left) < 0.3 * 2.4e3


def _regulated(name: str, command: Array, pressure: Array) -> Run:
    time = np.linspace(0.0, 0.05 * (command.size - 1), command.size)
    current = 0.004 + 0.016 * command / 500e3
    return run(name, time=time, current=current, pressure=pressure)


def test_a_pressure_on_stairs_keeps_their_corners() -> None:
    # Up and down in 8 s and in 4, ten samples a second, 40 kPa a stair.
    runs, truths = [], []
    for place, size in enumerate((160, 80, 120)):
        command, held, stood = triangle(size, 20e3, 480e3), 20e3, []
        for goal in command:
            held = goal if abs(goal - held) > 40e3 else held
            stood.append(held)
        truths.append(np.array(stood))
        seed = 10 * place
        read = truths[-1] + noise(size, 2e3, seed)
        current = 0.004 + 0.016 * command / 500e3
        runs.append(run(f"way {place}", current=current, pressure=read))
    rest = np.full(120, 200e3)
    runs.append(run("rest", current=0 * rest + 0.01, pressure=rest + noise(120, 2e3)))
    *ways, _ = cut(*runs)
    for way, true in zip(ways, truths, strict=True):
        assert way.on_stairs
        assert np.std(way.level("pressure") - true) < 1.25 * 2e3


def test_a_sample_in_the_middle_of_a_step_makes_no_noise_of_the_others() -> None:
    # Five samples a second of a regulator that follows within 15 ms.
    command = np.repeat([100e3, 400e3, 200e3, 450e3], 100)
    true = command.copy()
    true[[100, 200, 300]] -= 0.5 * np.diff(command)[[99, 199, 299]]
    time = np.linspace(0.0, 79.8, 400)
    current = 0.004 + 0.016 * command / 500e3
    (course,) = cut(run(time=time, current=current, pressure=true + noise(400, 2e3)))
    left = (course.level("pressure") - true)[np.abs(np.arange(400) % 100 - 50) < 45]
    assert np.std(left) < 0.5 * 2e3


@pytest.mark.parametrize("read", [0.0, 1e-16, 4e-6])
def test_what_a_resting_command_is_read_with_says_nothing_of_the_pressure(
    read: float,
) -> None:
    """Not even that it cannot be told from a line: numpy would warn."""
    pressure = 300e3 + noise(400, 2e3, memory=0.5)
    one, other = (
        cut(run(current=8e-3 + noise(400, read, seed), pressure=pressure))[0]
        for seed in (1, 2)
    )
    np.testing.assert_array_equal(one.level("pressure"), other.level("pressure"))


def test_a_staircase_without_a_command_has_no_noise_in_its_rests() -> None:
    true = np.repeat([0.0, 150e3, 300e3, 450e3, 300e3, 150e3, 0.0], 60)
    (course,) = cut(run(pressure=true + noise(420, 2e3)))
    rests = np.abs(np.arange(420) % 60 - 30) < 25
    assert np.std((course.level("pressure") - true)[rests]) < 0.3 * 2e3


def test_a_staircase_of_ramps_without_a_command_rests_between_its_corners() -> None:
    # Each rest of 6 s, and 1 s on the way to the next, ten samples a second.
    ends = np.arange(9) * 70
    knots = np.column_stack([ends, ends + 60]).ravel()
    levels = np.repeat([0.0, 150e3, 300e3, 450e3, 500e3, 450e3, 300e3, 150e3, 0.0], 2)
    true = np.interp(np.arange(620), knots, levels)
    (course,) = cut(run(pressure=true + noise(620, 2e3)))
    rests = np.abs(np.arange(620) % 70 - 30) < 25
    assert np.std((course.level("pressure") - true)[rests]) < 0.35 * 2e3


def test_noise_that_lasts_seldom_turns_a_pressure_round_in_a_staircase() -> None:
    # In 3 of these 10, and in each of them where nothing is done about it.
    assert sum(_turns_only_at_the_top(seed) for seed in range(10)) >= 7


def _turns_only_at_the_top(seed: int) -> bool:
    # Rests of 5 s and 1 s to the next, two samples a second, as a slow logger has them.
    ends = np.arange(11) * 12
    knots = np.column_stack([ends, ends + 10]).ravel()
    stairs = [126e3, 236e3, 347e3, 457e3, 568e3, 678e3, 568e3, 457e3, 347e3, 236e3]
    true = np.interp(np.arange(120), knots, np.repeat([*stairs, 126e3], 2))
    (course,) = cut(
        run(
            time=np.arange(0.0, 60.0, 0.5),
            pressure=true + noise(120, 2.2e3, seed, memory=0.6),
            contraction=0.065 + noise(120, 3e-4),
        )
    )
    pressure = course.level("pressure")
    # Where in the rest at the top it turned is not told.
    up, down = pressure[12:60], pressure[70:]
    back = [np.maximum.accumulate(up) - up, down - np.minimum.accumulate(down)]
    return bool(np.max(np.concatenate(back)) < 1.0)


def test_cycles_without_a_command_keep_their_corners_and_rest_in_their_holds() -> None:
    # Up in 1.5 s, held for 3 s, and down: the muscle travels meanwhile. 12 times.
    time = np.arange(0.0, 72.0, 0.09)
    knots, levels = [0.0, 1.5, 4.5, 6.0], [120e3, 360e3, 360e3, 120e3]
    true = np.interp(time % 6.0, knots, levels)
    (course,) = cut(run(time=time, pressure=true + noise(time.size, 2e3)))
    off = course.level("pressure") - true
    assert np.sqrt(np.mean(off**2)) < 1e3
    corner = np.abs(time % 6.0 - 1.5) < 0.1
    assert abs(np.mean(off[corner])) < 1.2e3


@pytest.mark.parametrize("seed", range(6))
def test_what_is_held_between_ways_there_and_back_does_not_go_back_yet(
    seed: int,
) -> None:
    # 1 % of the length a second there, 1.4 s at rest, and back.
    time = np.arange(0.0, 41.4, 0.1)
    true = np.interp(time, [0.0, 20.0, 21.4, 41.4], [0.0, 0.2, 0.2, 0.0])
    way = true + noise(time.size, 5e-4, seed=seed)
    (course,) = cut(run(time=time, contraction=way))
    back = float(time[course.direction < 0][0])
    assert back == pytest.approx(21.4, abs=0.35)


def test_what_is_quieter_than_told_does_not_leap() -> None:
    time = np.linspace(0.0, 39.9, 400)
    column = 300e3 + 200e3 * np.sin(time)
    leaping = smooth(time, column, 1.0, leap=LEAP)
    assert leaping.likelihood == -np.inf


def test_a_sample_that_a_step_cannot_have_caught_counts() -> None:
    # Fifty samples a second of a regulator that takes 60 ms: followed all the way.
    command = np.repeat([100e3, 400e3, 200e3, 450e3], 100)
    since = np.minimum(np.arange(400) % 100 + 1.0, 3.0) / 3.0
    before = np.append(np.full(100, 100e3), command[:-100])
    true = before + since * (command - before)
    told = true + noise(400, 2e3)
    current = 0.004 + 0.016 * command / 500e3
    (course,) = cut(
        run(time=np.linspace(0.0, 7.98, 400), current=current, pressure=told)
    )
    leaps = np.array([100, 200, 300])
    assert course.level("pressure")[leaps] == pytest.approx(true[leaps], abs=50e3)


def _pulling(seed: int) -> tuple[Course, Array]:
    """Pressure to and fro in five strokes at a fixed length, and the force it makes."""
    way = np.abs((np.arange(SIZE) / 80.0) % 2.0 - 1.0)
    pressure = 500e3 * way
    force = 2e-3 * pressure - 100.0
    (course,) = cut(
        run(
            current=0.004 + 0.016 * way,
            pressure=pressure + noise(SIZE, 1e3, seed),
            contraction=np.full(SIZE, 0.1),
            force=force + noise(SIZE, 8.0, seed + 50),
        )
    )
    return course, force


def test_force_keeps_the_corners_that_the_pressure_has() -> None:
    offs = []
    for seed in range(8):
        course, force = _pulling(seed)
        offs.append((course.level("force") - force)[80:321:80])
    # A trend alone is off by 15 N there, which the noise does not average to nought.
    np.testing.assert_allclose(np.mean(offs, axis=0), 0.0, atol=3.0)


def test_force_beside_pressure_has_less_noise_than_a_trend_alone() -> None:
    course, force = _pulling(0)
    alone = smooth(course.time, course.column("force"), 64.0)
    beside, trend = (
        float(np.std(level - force)) for level in (course.level("force"), alone.value)
    )
    assert beside < 0.5 * trend


def test_force_that_does_not_go_with_the_pressure_keeps_its_own_trend() -> None:
    # A slow drift beside a triangle: whatever follows the pressure adds corners to it.
    force = np.linspace(-200.0, 200.0, SIZE)
    (course,) = cut(
        run(
            pressure=triangle(SIZE) + noise(SIZE, 1e3),
            contraction=np.full(SIZE, 0.1),
            force=force + noise(SIZE, 2.0, 7),
        )
    )
    assert np.std(course.level("force") - force) < 0.3


def test_a_free_muscle_that_leaps_does_not_come_back() -> None:
    # Twenty samples a second; the step of the valve is over in three of them.
    true = np.repeat([0.0, 0.051], 60)
    true[60:62] = 0.0446, 0.0485
    for seed in range(5):
        (course,) = cut(
            run(
                time=0.05 * np.arange(120.0),
                pressure=np.repeat([55e3, 353e3], 60) + noise(120, 2e3, seed),
                contraction=true + noise(120, 2e-4, seed + 9),
            )
        )
        assert (course.direction[60:] == 1.0).all()
        assert np.abs(course.level("contraction") - true).max() < 4e-4


def test_a_load_that_swings_after_a_step_does_not_leap() -> None:
    # Fifty samples a second; after the step it swings at 5 Hz and comes to rest.
    since = np.maximum(np.arange(1500) - 500, 0) / 50.0
    swing = 1 - np.exp(-since / 0.15) * np.cos(2 * np.pi * 5 * since)
    measured = 0.03 * swing + noise(1500, 1e-4)
    time = 0.02 * np.arange(1500.0)
    (course,) = cut(run(time=time, contraction=measured, pressure=300e3 * swing))
    assert smooth(time, measured, 1e-8, leap=LEAP).leapt
    assert course.smooth["contraction"].leapt == ()


def test_a_slow_load_that_swings_does_not_leap_either() -> None:
    # Twenty samples a second; 3 Hz, and a noise by which a swing may pass for leaps.
    since = np.maximum(np.arange(600) - 200, 0) / 20.0
    swing = 1 - np.exp(-since / 0.2) * np.cos(2 * np.pi * 3 * since)
    for seed in range(8):
        (course,) = cut(
            run(
                time=0.05 * np.arange(600.0),
                contraction=0.03 * swing + noise(600, 5e-4, seed),
            )
        )
        assert course.smooth["contraction"].leapt == ()


def test_jaws_that_snap_shut_leave_what_rests_beside_it_as_quiet() -> None:
    # Between two samples, 25 of them a second.
    time = 0.04 * np.arange(260.0)
    true = np.where((time >= 1.0) & (time <= 9.0), 0.06, 0.0)
    errors = []
    for seed in range(6):
        (course,) = cut(run(time=time, contraction=true + noise(260, 5e-4, seed, 0.3)))
        errors.append(course.level("contraction") - true)
    assert np.std(errors) < 0.16 * 5e-4


def test_a_step_may_take_many_samples_if_it_goes_one_way() -> None:
    # A lag of 0.08 s, fifty samples a second.
    since = np.maximum(np.arange(1500) - 500, 0) / 50.0
    true = 0.05 * (1 - np.exp(-since / 0.08))
    for seed in range(3):
        (course,) = cut(
            run(
                time=0.02 * np.arange(1500.0),
                contraction=true + noise(1500, 1e-4, seed),
                pressure=300e3 + 1e6 * true,
            )
        )
        assert np.std(course.level("contraction") - true) < 2e-5
        assert (course.direction[501:] == 1.0).all()


def test_jaws_on_what_yields_go_to_and_fro() -> None:
    # Five grips of a soft object within 0.4 % of contraction, and 0.05 % noise.
    time = np.arange(0.0, 21.2, 0.1)
    true = 0.07 - 0.0021 * np.cos(2 * np.pi * time / 4.24)
    for seed in range(6):
        measured = true + noise(time.size, 5e-4, seed, 0.3)
        opening = 0.09 - 0.4 * true
        (course,) = cut(run(time=time, contraction=measured, opening=opening))
        assert np.std(course.level("contraction") - true) < 5e-4
        assert np.count_nonzero(np.diff(course.direction)) >= 9


def test_one_way_there_and_back_is_none_of_jaws_that_wander() -> None:
    # Within 0.28 % of contraction, once.
    time = np.arange(0.0, 21.2, 0.1)
    true = 0.07 - 0.0014 * np.cos(2 * np.pi * time / 21.2)
    for seed in range(6):
        measured = true + noise(time.size, 5e-4, seed, 0.3)
        opening = 0.09 - 0.4 * true
        (course,) = cut(run(time=time, contraction=measured, opening=opening))
        assert not course.direction.any()


@pytest.mark.parametrize(("std", "seeds"), [(7e-4, range(20)), (1e-3, (22, 55))])
def test_a_muscle_brought_to_its_length_before_a_hold_does_not_come_back(
    std: float, seeds: Sequence[int]
) -> None:
    time = np.arange(0.0, 30.0, 0.08)
    true = np.minimum(0.025 + 0.0175 * time, 0.0465)
    errors = []
    for seed in seeds:
        (course,) = cut(
            run(time=time, contraction=true + noise(time.size, std, seed, 0.3))
        )
        assert course.direction.min() == 0.0
        errors.append(course.level("contraction") - true)
    assert np.sqrt(np.mean(np.square(errors))) < 0.25 * std
