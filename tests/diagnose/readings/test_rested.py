from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.readings.course import Course, joined
from gripperd.diagnose.readings.cutting import courses
from gripperd.diagnose.readings.recording import Recording, Run
from gripperd.diagnose.readings.rested import with_rests
from gripperd.model.track import Array
from tests.diagnose.sweep import noise

STEP = 0.1


def _course(*corners: tuple[float, float, float], length: float = 1e-4) -> Course:
    """A sweep through corners: time in s, contraction, pressure in kPa."""
    ends, way, pressure = np.array(corners).T
    time = np.arange(0.0, ends[-1], STEP)
    columns = {
        "time": time,
        "contraction": np.interp(time, ends, way) + noise(time.size, length),
        "pressure": 1e3 * np.interp(time, ends, pressure) + noise(time.size, 500.0),
    }
    run = Run("a", columns)
    (found,), _ = courses(Recording("rests", "0" * 64, (run,)), 0.25)
    return found


def _at(course: Course, *moments: float) -> Array:
    return np.interp(moments, course.time, course.rested)


STAIRS = (
    (0.0, 0.0, 300.0), (4.0, 0.08, 300.0), (9.0, 0.08, 300.0),
    (13.0, 0.16, 300.0), (19.0, 0.16, 300.0), (27.0, 0.0, 300.0),
)  # fmt: skip


def test_on_each_stair_a_length_rests_from_when_it_came_there() -> None:
    course = _course(*STAIRS)
    moving = _at(course, 1.0, 3.0, 10.0, 12.0, 20.0, 22.0, 26.0)
    np.testing.assert_array_equal(moving, 0.0)
    resting = _at(course, 6.0, 8.0, 15.0, 18.0)
    # A trend comes to rest half a second late at most.
    np.testing.assert_allclose(resting, [2.0, 4.0, 2.0, 5.0], atol=0.5)
    np.testing.assert_array_equal(course.stood, course.rested)


def test_what_goes_on_slowly_does_not_rest_for_long() -> None:
    # A thirtieth of the speed that it came with, and 0.01 in all.
    course = _course((0.0, 0.0, 300.0), (2.0, 0.12, 300.0), (22.0, 0.13, 300.0))
    # 0.0015 of it are gone in 3 s.
    assert 2.5 < course.rested.max() < 3.6


def test_a_sweep_that_is_held_rests_from_its_beginning() -> None:
    course = _course((0.0, 0.1, 100.0), (10.0, 0.1, 400.0), (20.0, 0.1, 100.0))
    np.testing.assert_array_equal(course.rested, course.time - course.time[0])


def test_a_muscle_that_follows_its_pressure_is_held_by_its_own_friction() -> None:
    stairs = [(at, way, 100.0 + 2000.0 * way) for at, way, _ in STAIRS]
    assert not _course(*stairs).rested.any()


def test_a_pressure_that_goes_with_the_first_stair_alone_moves_no_muscle() -> None:
    """It rises with it by 2 bar, and swings where a machine holds the length."""
    course = _course(
        (0.0, 0.0, 100.0), (4.0, 0.08, 300.0), (7.0, 0.08, 100.0), (9.0, 0.08, 300.0),
        (13.0, 0.16, 100.0), (19.0, 0.16, 300.0), (27.0, 0.0, 100.0),
    )  # fmt: skip
    np.testing.assert_allclose(_at(course, 6.0, 15.0), [2.0, 2.0], atol=0.5)


def test_a_pressure_that_moves_ends_what_stands_and_no_rest() -> None:
    course = _course(
        (0.0, 0.1, 300.0), (5.0, 0.1, 300.0), (8.0, 0.1, 400.0), (15.0, 0.1, 400.0),
        (20.0, 0.1, 380.0), (25.0, 0.1, 380.0),
    )  # fmt: skip
    np.testing.assert_array_equal(course.rested, course.time - course.time[0])
    stood = np.interp([4.0, 6.5, 10.0, 14.0, 17.0, 24.0], course.time, course.stood)
    np.testing.assert_allclose(stood, [4.0, 0.0, 2.0, 6.0, 0.0, 4.0], atol=0.6)


def test_noise_moves_no_pressure() -> None:
    course = _course((0.0, 0.1, 300.0), (30.0, 0.1, 300.0))
    np.testing.assert_array_equal(course.stood, course.time - course.time[0])


def test_jaws_that_hold_an_object_are_no_machine() -> None:
    """A muscle that met it follows its pressure no more."""
    time = STEP * np.arange(400.0)
    pressure = 1e5 * np.interp(time, [0.0, 1.0, 39.0, 40.0], [0.0, 1.0, 1.0, 0.0])
    way = np.minimum(8e-7 * pressure, 0.08)
    pressure += 2e5 * (1 - np.cos(np.clip(time - 1.0, 0.0, 37.7)))
    columns = {
        "time": time, "contraction": way + noise(400, 1e-4),
        "pressure": pressure + noise(400, 500.0, 2),
        "grip": np.maximum(pressure - 1e5, 0.0) / 1e4 + noise(400, 0.3, 1),
    }  # fmt: skip
    runs = [Run("a", columns), Run("b", {**columns, "grip": np.full(400, np.nan)})]
    grasp, moved = courses(Recording("jaws", "0" * 64, tuple(runs)), 0.25)[0]
    assert not grasp.rested.any()
    assert moved.rested.any()


def test_where_no_pressure_is_known_what_rests_stands() -> None:
    time = STEP * np.arange(80.0)
    held = Run("a", {"time": time, "contraction": 0.1 + noise(80, 1e-4)})
    (course,), _ = courses(Recording("rests", "0" * 64, (held,)), 0.25)
    np.testing.assert_array_equal(course.stood, time)


def test_where_no_length_is_known_nothing_rests() -> None:
    blind = Run("a", {"time": STEP * np.arange(50.0), "force": noise(50, 1.0)})
    (course,), _ = courses(Recording("rests", "0" * 64, (blind,)), 0.25)
    np.testing.assert_array_equal(course.rested, np.zeros(50))


def test_laid_end_to_end_each_rests_for_itself() -> None:
    course = _course(*STAIRS)
    course = replace(course, stood=course.rested / 2)
    both = joined([course, course])
    np.testing.assert_array_equal(both.rested, np.tile(course.rested, 2))
    np.testing.assert_array_equal(both.stood, np.tile(course.stood, 2))


@pytest.mark.parametrize("length", [1e-4, 6e-4])
def test_noise_wakes_nothing(length: float) -> None:
    course = _course(*STAIRS, length=length)
    stairs = [course.rested[(course.time > a) & (course.time < b)] for a, b in
              ((5.0, 8.5), (14.0, 18.5))]  # fmt: skip
    assert all(np.all(np.diff(one) > 0) for one in stairs)


def test_a_trend_that_wiggles_in_a_rest_rests() -> None:
    """By 4 % of the speed of the way to and fro, and once by 15 %."""
    course = _course(*STAIRS)
    known, rest = course.smooth["contraction"], course.rested > 0
    wiggles = 0.02 * np.where(np.arange(len(course)) % 2, 0.04, -0.04)
    wiggles[[80, 170]] = 0.02 * 0.15
    restless = known._replace(rate=np.where(rest, wiggles, known.rate))
    told = replace(course, smooth={**course.smooth, "contraction": restless})
    np.testing.assert_array_equal(with_rests(told).rested, course.rested)
