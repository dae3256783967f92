"""A muscle that shortens and lengthens at one pressure, cut into courses."""

import numpy as np

from gripperd.diagnose.readings.course import Course
from gripperd.diagnose.readings.cutting import courses
from gripperd.diagnose.readings.recording import Recording, Run
from gripperd.model.track import Array
from tests.diagnose.sweep import noise, run

REST_LENGTH = 0.25
SIZE = 401
CORNER = SIZE // 2
WAY = 0.2 * (1.0 - np.abs(np.linspace(-1.0, 1.0, SIZE)))


def cut(*runs: Run) -> tuple[Course, ...]:
    """Courses of a recording of these runs."""
    return courses(Recording("r", "0" * 64, runs), REST_LENGTH)[0]


def cycled(contraction: Array, std: float = 2e-4, seed: int = 1) -> Course:
    """The one course of a contraction, measured with noise, at 300 kPa."""
    size = contraction.size
    (course,) = cut(
        run(
            pressure=300e3 + noise(size, 1e3, seed + 1),
            contraction=contraction + noise(size, std, seed),
        )
    )
    return course
