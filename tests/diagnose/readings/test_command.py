"""Currents that were written, and currents that were read back."""

import warnings

import numpy as np
import pytest

from gripperd.diagnose.readings.course import Course
from gripperd.diagnose.readings.cutting import courses
from gripperd.diagnose.readings.recording import Recording
from gripperd.model.track import Array
from tests.diagnose.sweep import noise, run

SIZE = 400
STEP = 0.05
READING = 80e-6
"""Noise of a current that was read: half a per cent of the span. [A]"""


def _plan() -> Array:
    """A ramp there and back, then stairs. [A]"""
    ramp = np.interp(np.linspace(0, 1, 200), [0, 0.5, 1], [4e-3, 18e-3, 6e-3])
    stairs = np.repeat([6e-3, 12e-3, 9e-3, 16e-3], 50)
    return np.concatenate([ramp, stairs])


def _course(followed: Array, told: Array) -> Course:
    sweeps = tuple(
        run(
            str(place),
            time=60.0 * place + STEP * np.linspace(0, SIZE - 1, SIZE),
            current=told + 0.0 * place,
            pressure=(followed - 4e-3) / 16e-3 * 500e3 + noise(SIZE, 1e3, place),
        )
        for place in range(2)
    )
    return courses(Recording("read", "", sweeps), 0.25)[0][1]


def test_the_noise_of_a_current_that_was_read_is_taken_off() -> None:
    command = _plan()
    read = command + noise(SIZE, READING, 7)
    found = _course(command, read).column("current")
    assert np.sqrt(np.mean((found - command) ** 2)) < 0.45 * READING


def test_so_is_that_of_a_good_meter() -> None:
    command = _plan()
    read = command + noise(SIZE, READING / 10, 7)
    found = _course(command, read).column("current")
    assert np.sqrt(np.mean((found - command) ** 2)) < 0.6 * READING / 10


def test_what_rests_is_told_as_a_mean_of_it_all() -> None:
    command = _plan()
    found = _course(command, command + noise(SIZE, READING, 7)).column("current")
    for start in (200, 250, 300, 350):
        rest = slice(start + 6, start + 48)
        assert np.ptp(found[rest]) == 0.0
        assert found[start + 6] == pytest.approx(
            command[start], abs=3 * READING / 44**0.5
        )


def test_where_no_reading_is_there_is_no_rest() -> None:
    command = _plan()
    read = command + noise(SIZE, READING, 7)
    read[360:] = np.nan
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = _course(command, read).column("current")
    assert np.isnan(found[360:]).all()
    assert np.isfinite(found[:360]).all()


def test_a_slow_ramp_is_followed() -> None:
    command = np.linspace(8e-3, 9e-3, SIZE)
    found = _course(command, command + noise(SIZE, READING, 7)).column("current")
    assert np.sqrt(np.mean((found - command) ** 2)) < 0.3 * READING


def test_a_step_stays_a_step() -> None:
    command = _plan()
    found = _course(command, command + noise(SIZE, READING, 7)).column("current")
    assert found[250] - found[249] == pytest.approx(6e-3, rel=0.05)


def test_the_time_since_a_step_goes_on_while_the_command_rests() -> None:
    command = _plan()
    found = _course(command, command + noise(SIZE, READING, 7)).still
    assert found[295] == pytest.approx(45 * STEP, abs=2 * STEP)


def test_a_command_that_was_written_stays_as_it_is() -> None:
    command = _plan()
    assert np.array_equal(_course(command, command).column("current"), command)


def test_what_the_pressure_follows_was_commanded() -> None:
    jagged = _plan() + noise(SIZE, READING, 7)
    assert np.array_equal(_course(jagged, jagged).column("current"), jagged)


def test_a_ramp_read_at_an_uneven_clock_is_no_command_that_wiggles() -> None:
    """Read with 12 bits of 24 mA: it bends with the clock, and the pressure with it."""
    random = np.random.default_rng(5)
    time = np.cumsum(random.uniform(0.05, 0.11, 2 * SIZE))
    corners = [4e-3, *[18e-3, 6e-3] * 4]
    command = np.interp(time, np.linspace(0, 40, 9), corners)
    step = 24e-3 / 4096
    read = np.round((command + random.normal(0, 6e-6, time.size)) / step) * step
    pressure = (command - 4e-3) / 16e-3 * 500e3 + random.normal(0, 500.0, time.size)
    sweeps = (run("read", time=time, current=read, pressure=pressure),)
    (course,), _ = courses(Recording("read", "", sweeps), 0.25)
    rests = time > 42
    found = course.column("current")
    assert np.std((found - command)[rests]) < 1e-6 < np.std((read - command)[rests])
