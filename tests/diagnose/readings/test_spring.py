"""Muscles that a spring holds, whose lengths follow from their pressure."""

import numpy as np
import pytest

from gripperd.diagnose.noise.smoothing import OF_LENGTH, smooth
from gripperd.diagnose.readings.course import Course
from gripperd.diagnose.readings.recording import Run
from gripperd.diagnose.readings.spring import on_spring
from gripperd.model.track import Array
from tests.diagnose.cycled import cut
from tests.diagnose.sweep import noise, run, triangle

LOUD = 6e-4
"""Noise of the contraction. [-]"""
GIVE = 0.012 / 500e3
"""Contraction by pressure: 3 mm of 250 mm at 5 bar. [1/Pa]"""
TREADS = np.array([100e3, 320e3, 540e3, 280e3, 150e3, 520e3, 100e3])
LONG = 12
"""Samples of a tread."""
STAIRS = np.repeat(TREADS, LONG)


def _read(pressure: Array, way: Array) -> Run:
    """Four times a second, with what the regulator was told."""
    size = pressure.size
    return run(
        time=np.arange(0.0, 0.25 * size, 0.25),
        current=0.004 + 0.016 * pressure / 600e3,
        pressure=pressure + noise(size, 1e3, 1),
        contraction=way + noise(size, LOUD, 2),
    )


def _held(way: Array) -> Course:
    (course,) = cut(_read(STAIRS, way))
    return course


def _off(course: Course, way: Array) -> float:
    return float(np.sqrt(np.mean((course.level("contraction") - way) ** 2)))


def test_a_length_leaps_with_the_pressure_that_a_spring_feels() -> None:
    way = 0.05 + GIVE * STAIRS
    course = _held(way)
    assert _off(course, way) < 0.5 * LOUD
    # It neither sets out before a step nor turns round before the next.
    signs = np.sign(np.diff(TREADS))
    for step, sign in enumerate(signs, start=1):
        assert course.direction[step * LONG + 2] == sign
        assert course.direction[(step + 1) * LONG - 2] == sign


def test_a_length_that_drifts_beside_is_followed() -> None:
    way = 0.05 + GIVE * STAIRS + np.linspace(0.0, 0.004, STAIRS.size)
    assert _off(_held(way), way) < 0.5 * LOUD


@pytest.mark.parametrize(
    ("pressure", "way"),
    [
        (STAIRS, 0.05 - GIVE * STAIRS),
        (STAIRS, triangle(STAIRS.size, 0.02, 0.15)),
        (np.full_like(STAIRS, 300e3), triangle(STAIRS.size, 0.02, 0.15)),
    ],
    ids=["the other way", "moved by a machine", "under one pressure"],
)
def test_what_no_spring_explains_is_left(pressure: Array, way: Array) -> None:
    sweep = _read(pressure, way)
    time, column = sweep.columns["time"], sweep.columns["contraction"]
    plain = smooth(time, column, LOUD**2, tried=OF_LENGTH)
    known = plain._replace(value=pressure, rate=np.zeros(pressure.size))
    assert on_spring(sweep, plain, known) is plain
