from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.noise.smoothing import Smooth
from gripperd.diagnose.readings.course import Course, joined
from gripperd.diagnose.readings.cutting import courses
from gripperd.diagnose.readings.halts import halts
from gripperd.diagnose.readings.recording import Recording, Run
from tests.diagnose.sweep import noise

STEP = 0.1


def _course(*corners: tuple[float, float, float]) -> Course:
    """A sweep through corners: time in s, contraction, pressure in kPa."""
    ends, way, pressure = np.array(corners).T
    time = np.arange(0.0, ends[-1], STEP)
    columns = {
        "time": time,
        "contraction": np.interp(time, ends, way) + noise(time.size, 1e-4),
        "pressure": 1e3 * np.interp(time, ends, pressure) + noise(time.size, 500.0),
    }
    run = Run("a", columns)
    (found,), _ = courses(Recording("halts", "0" * 64, (run,)), 0.25)
    return found


def _about(stretch: slice, start: float, end: float) -> None:
    """It has all of that, and of the ways beside it less than counts as reversed."""
    assert start - 0.5 <= STEP * stretch.start <= start + 1.0
    assert end - 0.5 <= STEP * stretch.stop <= end + 1.0


BROUGHT = (0.0, 0.0, 100.0), (5.0, 0.1, 100.0)


def test_a_muscle_that_is_brought_to_its_length_and_inflated_halts_there() -> None:
    course = _course(*BROUGHT, (15.0, 0.1, 400.0), (25.0, 0.1, 100.0))
    (halt,) = course.halts
    _about(halt, 5.0, 25.0)


def test_it_halts_at_every_length_at_which_it_is_inflated() -> None:
    course = _course(
        *BROUGHT, (10.0, 0.1, 300.0), (15.0, 0.1, 100.0),
        (20.0, 0.2, 100.0), (25.0, 0.2, 300.0), (30.0, 0.2, 100.0),
    )  # fmt: skip
    first, second = course.halts
    _about(first, 5.0, 15.0)
    _about(second, 20.0, 30.0)


@pytest.mark.parametrize(
    "then",
    [
        pytest.param(((25.0, 0.1, 100.0),), id="nothing goes on"),
        pytest.param(((25.0, 0.2, 400.0),), id="it travels with its pressure"),
        pytest.param(((15.0, 0.1, 105.0), (25.0, 0.1, 100.0)), id="hardly goes on"),
    ],
)
def test_otherwise_it_does_not(then: tuple[tuple[float, float, float], ...]) -> None:
    assert _course(*BROUGHT, *then).halts == ()


def test_a_sweep_without_travel_rests_and_does_not_halt() -> None:
    assert _course((0.0, 0.1, 0.0), (10.0, 0.1, 400.0), (20.0, 0.1, 0.0)).halts == ()


def test_where_its_pressure_is_not_known_nothing_is() -> None:
    course = _course(*BROUGHT, (15.0, 0.1, 400.0))
    unknown = np.full_like(course.time, np.nan)
    blind = {**course.smooth, "pressure": Smooth(unknown, unknown)}
    assert halts(replace(course, smooth=blind)) == ()


def test_laid_end_to_end_each_halts_where_it_did() -> None:
    course = _course(*BROUGHT, (15.0, 0.1, 400.0), (25.0, 0.1, 100.0))
    (halt,) = course.halts
    first, second = joined([course, course]).halts
    assert first == halt
    assert second == slice(halt.start + len(course), halt.stop + len(course))
