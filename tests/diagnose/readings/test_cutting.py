from itertools import pairwise

import numpy as np
import pytest

from gripperd.diagnose.readings.course import Course
from gripperd.diagnose.readings.cutting import courses
from gripperd.diagnose.readings.recording import Recording, Run
from gripperd.errors import InputError
from tests.diagnose.cycled import CORNER, REST_LENGTH, SIZE, WAY, cut, cycled
from tests.diagnose.sweep import noise, run, triangle


def _after(run: Run, start: float) -> Run:
    return Run(run.name, {**run.columns, "time": run.columns["time"] + start})


@pytest.mark.parametrize("std", [0.0, 2e-4, 5e-4])
def test_the_reversal_lies_at_the_corner(std: float) -> None:
    direction = cycled(WAY, std).direction
    np.testing.assert_array_equal(direction[5 : CORNER - 4], 1.0)
    np.testing.assert_array_equal(direction[CORNER + 5 :], -1.0)


def _rested(leg: int, rest: int, seed: int) -> Course:
    """There by 8e-4 a sample, a rest, and back; noise of as much."""
    ends = np.cumsum([20, leg, rest, leg])
    way = np.interp(np.arange(ends[-1]), ends, 8e-4 * leg * np.array([0, 1, 1, 0]))
    (course,) = cut(run(contraction=way + noise(way.size, 8e-4, seed)))
    return course


@pytest.mark.parametrize(("rest", "seed"), [(20, 0), (20, 9), (30, 9)])
def test_a_travel_that_rests_at_its_turn_turns_with_the_way_back(
    rest: int, seed: int
) -> None:
    (turn,) = 1 + np.flatnonzero(np.diff(_rested(240, rest, seed).direction) == -2)
    assert abs(turn - 260 - rest) <= 3


@pytest.mark.parametrize("seed", [0, 2])
def test_of_short_ways_it_is_not_known_where_they_rest(seed: int) -> None:
    course = _rested(40, 12, seed)
    (turn,) = 1 + np.flatnonzero(np.diff(course.direction) == -2)
    left_out = np.asarray(course.smooth["contraction"].unsure)
    assert turn < 72 - 1
    assert left_out[turn:71].all()


@pytest.mark.parametrize("seed", range(5))
def test_after_a_small_step_back_no_friction_acts_the_old_way(seed: int) -> None:
    """Down, a rest, up by two sigma of the noise, a rest, and on."""
    ends = np.cumsum([0, 20, 60, 40, 10, 60, 20, 60])
    steps = [0.1, 0.1, 0.05, 0.05, 0.0507, 0.0507, 0.08, 0.08]
    way = np.interp(np.arange(ends[-1]), ends, steps)
    (course,) = cut(run(contraction=way + noise(way.size, 3e-4, seed)))
    unsure = np.asarray(course.smooth["contraction"].unsure)
    rest = slice(136, 188)
    assert (unsure | (course.direction > 0))[rest].all()


def test_noise_alone_does_not_turn_the_travel() -> None:
    for seed in range(5):
        direction = cycled(WAY, 5e-4, seed).direction
        assert np.count_nonzero(np.diff(direction[direction != 0])) == 1


def test_noise_in_a_rest_between_two_strokes_does_not_turn_the_travel() -> None:
    places = np.linspace(0, SIZE, 15)
    steps = np.repeat([0.0, 0.065, 0.13, 0.195, 0.13, 0.065, 0.0], 2)
    way = np.interp(np.arange(SIZE), np.append(places[:-1], SIZE), np.append(steps, 0))
    for seed in range(4):
        signs = cycled(way, 1e-3, seed).direction
        assert np.count_nonzero(np.diff(signs[signs != 0])) == 1


def test_a_contraction_that_breaks_off_has_travelled_before() -> None:
    broken = WAY.copy()
    broken[-80:] = np.nan
    signs = cycled(broken).direction
    assert (signs[5 : CORNER - 5] == 1).all()
    assert (signs[CORNER + 5 : 300] == -1).all()


def test_a_muscle_that_is_held_does_not_travel() -> None:
    course = cycled(np.full(SIZE, 0.1), 5e-4)
    assert not course.direction.any()
    assert np.ptp(course.level("contraction")) == 0


def test_at_rest_the_direction_is_kept() -> None:
    way = np.interp(np.arange(SIZE), [0, 100, 300, 400], [0.0, 0.1, 0.1, 0.0])
    np.testing.assert_array_equal(cycled(way).direction[10:297], 1.0)


def test_without_contraction_there_is_no_direction() -> None:
    (course,) = cut(run(pressure=triangle(), force=triangle()))
    assert not course.direction.any()


def test_a_length_becomes_a_contraction() -> None:
    (course,) = cut(run(length=REST_LENGTH * (1 - WAY)))
    np.testing.assert_allclose(course.column("contraction"), WAY, atol=1e-12)


def test_a_length_tells_where_the_column_of_contraction_is_empty() -> None:
    empty = np.full(WAY.size, np.nan)
    (course,) = cut(run(length=REST_LENGTH * (1 - WAY), contraction=empty))
    np.testing.assert_allclose(course.column("contraction"), WAY, atol=1e-12)


def test_what_was_not_measured_is_not_a_number() -> None:
    course = cycled(WAY)
    assert np.isnan(course.column("force")).all()
    assert np.isnan(course.level("force")).all()


def test_a_pause_cuts_a_run_in_two() -> None:
    time = np.concatenate([0.1 * np.arange(100), 60.0 + 0.1 * np.arange(50)])
    first, second = cut(run("x", time=time, pressure=noise(150, 1e3)))
    assert (first.run, len(first), second.run, len(second)) == ("x#1", 100, "x#2", 50)
    assert second.time[0] == 60.0
    assert second.step[0] == 0.0


def test_a_run_without_a_pause_keeps_its_name() -> None:
    (course,) = cut(run("x", pressure=noise(100, 1e3)))
    assert course.run == "x"


def test_stillness_is_the_time_since_the_command_moved() -> None:
    current = np.repeat([0.004, 0.012, 0.012, 0.008], 50)
    (course,) = cut(run(current=current, pressure=noise(200, 1e3)))
    assert course.still[49] == pytest.approx(4.9)
    assert course.still[50] == 0.0
    assert course.still[149] == pytest.approx(9.9)
    assert course.still[150] == 0.0


def test_a_command_that_was_not_read_at_first_moves_all_the_same() -> None:
    current = np.repeat([0.004, 0.012, 0.012, 0.008], 50)
    current[[0, 1, 50, 120]] = np.nan
    (course,) = cut(run(current=current, pressure=noise(200, 1e3)))
    # The step that was missed is seen a sample late.
    assert course.still[[0, 49, 51, 120, 149]] == pytest.approx([0, 4.9, 0, 6.9, 9.8])
    assert course.still[150] == 0.0


def test_a_stated_noise_is_a_lower_limit() -> None:
    runs = (run(pressure=triangle() + noise(400, 1e3)),)
    stated = Recording("r", "0" * 64, runs, noise={"pressure": 5e3})
    plain = courses(Recording("r", "0" * 64, runs), REST_LENGTH)[1]["pressure"].std
    assert plain == pytest.approx(1e3, rel=0.2)
    assert courses(stated, REST_LENGTH)[1]["pressure"].std == 5e3


def test_set_points_of_a_few_settled_points_are_no_noise() -> None:
    points = 1e3 * np.array([0.0, 150.0, 300.0, 450.0, 300.0, 150.0, 0.0])
    runs = tuple(
        _after(run(f"{n}", pressure=points + noise(7, 500.0, n)), 100.0 * n)
        for n in range(8)
    )
    found = courses(Recording("r", "0" * 64, runs), REST_LENGTH)[1]["pressure"]
    assert found.std < 1e3


def test_sweeps_come_in_the_order_of_the_recording() -> None:
    runs = [
        _after(run(name, pressure=triangle()), 100.0 * n)
        for n, name in enumerate("xyz")
    ]
    parts = cut(*runs)
    assert [course.run for course in parts] == ["x", "y", "z"]
    assert all(a.time[-1] < b.time[0] for a, b in pairwise(parts))


def test_runs_too_short_to_be_sweeps_are_refused() -> None:
    pieces = tuple(
        Run(f"{place}", {"time": place + np.arange(3.0), "pressure": np.ones(3)})
        for place in range(100)
    )
    with pytest.raises(InputError, match="no run has 4 samples without a pause"):
        courses(Recording("torn", "0" * 64, pieces), REST_LENGTH)


@pytest.mark.parametrize("stated", [0.0, 5e-3])
def test_where_a_length_is_held_its_noise_is_not_told_from_quick_ways(
    stated: float,
) -> None:
    """Three held lengths, and three that swing in forty samples: read by 1e-3.

    By its neighbours alone that noise lasts, and a mean over many hears 20e-3 of it.
    """
    quick = 0.04 * (1 - np.cos(2 * np.pi * np.arange(160) / 40))
    held = np.r_[np.linspace(0.0, 0.05, 6), np.full(100, 0.05)]
    runs = tuple(
        run(f"{place}", contraction=each + noise(each.size, 1e-3, place))
        for place, each in enumerate([quick, held] * 3)
    )
    told = Recording("r", "0" * 64, runs, noise={"contraction": stated})
    found = courses(told, REST_LENGTH)[1]["contraction"]
    assert found.std >= max(stated, 1e-3)
    assert found.slow_variance**0.5 < 4e-3 or stated


def test_the_noise_of_a_length_is_that_of_its_contraction() -> None:
    length = REST_LENGTH * (1 - 0.2 * triangle(low=0.0, high=1.0))
    sweep = run(pressure=triangle(), length=length + noise(400, 1e-5))
    stated = Recording("r", "0" * 64, (sweep,), noise={"length": 1e-3})
    assert courses(stated, REST_LENGTH)[1]["contraction"].std == 1e-3 / REST_LENGTH
