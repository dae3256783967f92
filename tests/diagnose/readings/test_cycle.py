import numpy as np

from gripperd.diagnose.readings.course import Course
from gripperd.diagnose.readings.cutting import courses
from gripperd.diagnose.readings.recording import Recording, Run
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


def test_a_run_that_ends_inflated_ends_an_inflation() -> None:
    up = np.linspace(0.0, 500e3, 100)
    held = np.full(100, 400e3)
    first, second = _cut(run("x", pressure=up), _after(run("y", pressure=held), 100.0))
    assert (first.cycle[-1], second.cycle[0]) == (0, 1)
