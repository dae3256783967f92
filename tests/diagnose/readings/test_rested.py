from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.readings.course import Course, joined
from gripperd.diagnose.readings.cutting import courses
from gripperd.diagnose.readings.recording import Recording, Run
from gripperd.diagnose.readings.rested import rested
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


def test_where_no_length_is_known_nothing_rests() -> None:
    blind = Run("a", {"time": STEP * np.arange(50.0), "force": noise(50, 1.0)})
    (course,), _ = courses(Recording("rests", "0" * 64, (blind,)), 0.25)
    np.testing.assert_array_equal(course.rested, np.zeros(50))


def test_laid_end_to_end_each_rests_for_itself() -> None:
    course = _course(*STAIRS)
    both = joined([course, course]).rested
    np.testing.assert_array_equal(both, np.tile(course.rested, 2))


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
    np.testing.assert_array_equal(rested(told), course.rested)
