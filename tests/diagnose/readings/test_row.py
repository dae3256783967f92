import numpy as np
import pytest

from gripperd.diagnose.readings.course import Course
from gripperd.diagnose.readings.cutting import courses
from gripperd.diagnose.readings.recording import Recording, Run
from gripperd.diagnose.readings.row import alike
from tests.diagnose.sweep import noise, run, triangle

REST_LENGTH = 0.25
SIZE = 401
WAY = 0.2 * (1.0 - np.abs(np.linspace(-1.0, 1.0, SIZE)))


def _cut(*runs: Run) -> tuple[Course, ...]:
    return courses(Recording("r", "0" * 64, runs), REST_LENGTH)[0]


def _after(run: Run, start: float) -> Run:
    return Run(run.name, {**run.columns, "time": run.columns["time"] + start})


def _row(*contractions: float) -> list[float]:
    runs = [
        _after(
            run(
                str(place),
                pressure=triangle() + noise(400, 1e3, place),
                contraction=np.full(400, contraction),
            ),
            100.0 * place,
        )
        for place, contraction in enumerate(contractions)
    ]
    return [float(course.repeat[0]) for course in _cut(*runs)]


def test_repeats_in_an_unbroken_row_are_counted() -> None:
    np.testing.assert_array_equal(
        _row(0.0, 0.1, 0.1, 0.1, 0.0), [np.nan, 0, 1, 2, np.nan]
    )


def test_a_single_repeat_is_no_row() -> None:
    assert np.isnan(_row(0.1, 0.1, 0.0)).all()


def test_sweeps_without_a_reading_in_common_are_not_alike() -> None:
    first, second = np.full(400, np.nan), np.full(400, np.nan)
    first[:200] = second[200:] = 0.1
    one, other = (
        run("a", pressure=triangle(), contraction=contraction)
        for contraction in (first, second)
    )
    assert not alike(one, other)


def test_sweeps_are_alike_when_they_ask_the_same() -> None:
    one = run(pressure=triangle(), contraction=np.full(400, 0.1), force=triangle())
    other = run(pressure=triangle() + 5e3, contraction=np.full(400, 0.1), force=WAY)
    assert alike(one, other)


@pytest.mark.parametrize(
    "other",
    [
        pytest.param(
            run(pressure=triangle(), contraction=np.full(400, 0.15)), id="length"
        ),
        pytest.param(
            run(pressure=triangle(high=400e3), contraction=np.full(400, 0.1)),
            id="pressure",
        ),
        pytest.param(
            run(pressure=triangle(200), contraction=np.full(200, 0.1)), id="duration"
        ),
        pytest.param(run(pressure=triangle()), id="columns"),
    ],
)
def test_sweeps_that_differ_are_not_alike(other: Run) -> None:
    assert not alike(run(pressure=triangle(), contraction=np.full(400, 0.1)), other)


def test_whichever_comes_first_they_are_alike_or_not() -> None:
    still = np.full(400, 0.1)
    told = run(pressure=triangle(), contraction=still, current=triangle() / 5e7)
    untold = run(pressure=triangle(), contraction=still)
    assert not alike(told, untold)
    assert not alike(untold, told)
    # Apart by 3.05 % of the smaller one's top on average, 2.87 % of the larger one's.
    more = run(pressure=1.061 * triangle(low=0.0), contraction=still)
    less = run(pressure=triangle(low=0.0), contraction=still)
    assert alike(more, less)
    assert alike(less, more)


def test_sweeps_that_tell_nothing_of_what_was_asked_are_not_alike() -> None:
    assert not alike(run(force=triangle()), run(force=-triangle()))
