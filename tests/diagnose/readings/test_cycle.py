import numpy as np

from gripperd.diagnose.readings.course import Course
from gripperd.diagnose.readings.cutting import courses
from gripperd.diagnose.readings.recording import Recording, Run
from gripperd.model.track import Array
from tests.diagnose.sweep import run, triangle

REST_LENGTH = 0.25


def _cut(*runs: Run) -> tuple[Course, ...]:
    return courses(Recording("r", "0" * 64, runs), REST_LENGTH)[0]


def _after(run: Run, start: float) -> Run:
    return Run(run.name, {**run.columns, "time": run.columns["time"] + start})


def test_inflations_are_counted_when_they_end() -> None:
    twice = np.concatenate([triangle(100, 0.0), triangle(100, 0.0)])
    first, second = _cut(
        run("x", pressure=twice), _after(run("y", pressure=twice), 100.0)
    )
    assert (first.cycle[0], first.cycle[50], first.cycle[130]) == (0, 0, 1)
    # One ended inside the first run, one with it; the second run begins at two.
    assert (first.cycle[-1], second.cycle[0], second.cycle[-1]) == (2, 2, 4)


def test_a_muscle_that_is_cycled_without_being_vented_tires_of_every_cycle() -> None:
    # To 480 kPa and back to 170 kPa, five times, of 500 kPa in all.
    down_up = np.concatenate(
        [np.linspace(480e3, 170e3, 40), np.linspace(170e3, 480e3, 40)]
    )
    up, down = np.linspace(0.0, 480e3, 60), np.linspace(480e3, 0.0, 60)
    fatiguing = np.concatenate([up, np.tile(down_up, 4), down])
    first, second = _cut(
        run("x", pressure=fatiguing), _after(run("y", pressure=triangle(100)), 500.0)
    )
    assert first.cycle[-1] == 5
    assert second.cycle[0] == 5
    assert (np.diff(first.cycle) <= 1).all()


def test_a_pressure_that_is_changed_by_less_is_one_inflation() -> None:
    # Minor loops between 480 and 300 kPa.
    down_up = np.concatenate(
        [np.linspace(480e3, 300e3, 40), np.linspace(300e3, 480e3, 40)]
    )
    up, down = np.linspace(0.0, 480e3, 60), np.linspace(480e3, 0.0, 60)
    (course,) = _cut(run("x", pressure=np.concatenate([up, np.tile(down_up, 4), down])))
    assert course.cycle[-1] == 1


def test_a_run_that_ends_inflated_ends_an_inflation() -> None:
    up = np.linspace(0.0, 500e3, 100)
    held = np.full(100, 400e3)
    first, second = _cut(run("x", pressure=up), _after(run("y", pressure=held), 100.0))
    assert (first.cycle[-1], second.cycle[0]) == (0, 1)


def _command(pressure: Array) -> Array:
    return 4e-3 + 16e-3 * pressure / 500e3


def test_a_command_tells_of_inflations_where_the_pressure_failed() -> None:
    up_down = triangle(100, 0.0, 300e3)
    twice = np.concatenate([up_down, up_down])
    runs = [
        run("a", pressure=twice, current=_command(twice)),
        run("b", pressure=np.full(200, np.nan), current=_command(twice)),
        run("c", current=_command(twice)),
        run("d", pressure=twice),
    ]
    found = _cut(*(_after(one, 100.0 * n) for n, one in enumerate(runs)))
    assert [course.cycle[0] for course in found] == [0, 2, 4, 6]
    assert [course.cycle[130] for course in found] == [1, 3, 5, 7]


def test_readings_that_are_missing_end_no_inflation() -> None:
    pressure = np.repeat([0.0, 500e3, np.nan, 500e3, 0.0], 20)
    (course,) = _cut(run("x", pressure=pressure))
    assert (course.cycle[79], course.cycle[80]) == (0, 1)


def test_without_pressure_and_command_no_inflation_is_known() -> None:
    first, second = _cut(
        run("x", force=triangle()), _after(run("y", force=triangle()), 100.0)
    )
    assert not first.cycle.any()
    assert not second.cycle.any()


def test_an_inflation_ends_with_its_run_whatever_the_run_is_called() -> None:
    held = np.full(100, 400e3)
    first, second = _cut(
        run("A#1", pressure=held), _after(run("A#2", pressure=held), 100.0)
    )
    assert (first.cycle[-1], second.cycle[0]) == (0, 1)


def test_a_pause_of_the_log_ends_no_inflation() -> None:
    time = np.concatenate([0.1 * np.arange(100), 60.0 + 0.1 * np.arange(100)])
    held = np.concatenate([np.linspace(0.0, 400e3, 100), np.full(100, 400e3)])
    first, second, last = _cut(
        run("x", time=time, pressure=held),
        _after(run("y", pressure=triangle(100)), 500.0),
    )
    assert (first.cycle[-1], second.cycle[0], second.cycle[-1]) == (0, 0, 0)
    assert last.cycle[0] == 1
