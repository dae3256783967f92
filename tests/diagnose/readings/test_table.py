"""Maps of settled points and quick ramps that somebody logged once a second."""

import numpy as np
import pytest

from gripperd.diagnose.readings.course import is_table
from gripperd.diagnose.readings.cutting import courses
from gripperd.diagnose.readings.recording import Recording
from gripperd.model.track import Array
from tests.diagnose.sweep import run

SIZE = 21


def _is_table(*clocks: Array) -> bool:
    pressure = np.linspace(0.0, 500e3, SIZE)
    runs = tuple(
        run(str(place), time=clock, pressure=pressure, force=2e-3 * pressure)
        for place, clock in enumerate(clocks)
    )
    return is_table(courses(Recording("map", "", runs), 0.25)[0])


@pytest.mark.parametrize("first", [0.0, 1.0])
def test_a_counter_counts_on_or_begins_again(first: float) -> None:
    count = first + np.linspace(0.0, SIZE - 1, SIZE)
    assert _is_table(count, count + SIZE, count + 2 * SIZE)
    assert _is_table(count, count, count)


def test_a_logger_goes_on_while_the_rig_is_set_up() -> None:
    second = np.linspace(0.0, SIZE - 1, SIZE)
    assert not _is_table(second, second + 80, second + 160)


def test_a_clock_of_other_steps_is_no_counter() -> None:
    clock = 0.95 * np.linspace(0.0, SIZE - 1, SIZE)
    assert not _is_table(clock, clock + 0.95 * SIZE)
