from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.residuals.holdout import Split, split
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.setup import problem_of
from gripperd.diagnose.verdict.extrapolation import apart, extrapolation, swept
from gripperd.diagnose.verdict.gap import by_signal
from gripperd.model.effect import Signal
from tests.diagnose.small import MODEL, altered, recording


def _left_out(problem: Problem, *runs: str) -> Split:
    """The split in which these sweeps take no part."""
    out = tuple(
        np.full(len(course), course.run in runs, dtype=bool)
        for course in problem.courses
    )
    return Split(
        replace(problem, kept=tuple(~mask for mask in out)),
        replace(problem, kept=out),
        tuple(course.run for course in problem.courses if course.run in runs),
    )


@pytest.fixture(scope="module")
def warm() -> Problem:
    """The sweep f was run 20 K warmer than the others."""
    plain = recording()
    runs = tuple(
        replace(
            run,
            columns={
                **run.columns,
                "temperature": np.full(len(run), 293.0 + 20.0 * (run.name == "f")),
            },
        )
        for run in plain.runs
    )
    return problem_of(replace(plain, runs=runs), MODEL, {})


def _beyond(parts: Split) -> tuple[str, ...]:
    _, outside = apart(parts)
    return swept(parts, outside) if outside else ()


def test_sweeps_between_the_others_are_no_extrapolation(blank: Problem) -> None:
    parts = split(blank)
    inside, outside = apart(parts)
    assert outside is None
    assert swept(parts, inside) == parts.runs


@pytest.mark.parametrize(
    ("runs", "beyond"),
    [
        pytest.param(("e",), ("e",), id="the highest isobar at that length"),
        pytest.param(("d",), (), id="an isobar inside"),
        pytest.param(("d", "e"), ("e",), id="one of each"),
    ],
)
def test_fewer_lengths_elsewhere_make_an_extrapolation(
    blank: Problem, runs: tuple[str, ...], beyond: tuple[str, ...]
) -> None:
    # The sweep e is made the only one that goes beyond a contraction of 0.17.
    short = tuple(
        replace(
            course,
            smooth={
                **course.smooth,
                "contraction": course.smooth["contraction"]._replace(
                    value=np.minimum(course.level("contraction"), 0.17)
                ),
            },
        )
        if course.run != "e"
        else course
        for course in blank.courses
    )
    assert _beyond(_left_out(replace(blank, courses=short), *runs)) == beyond


def test_a_temperature_that_was_never_searched_is_beyond(warm: Problem) -> None:
    assert _beyond(_left_out(warm, "f")) == ("f",)
    assert _beyond(_left_out(warm, "d")) == ()


def test_a_faster_sweep_is_beyond() -> None:
    fast = altered(
        recording(), ["f"], "time", lambda time: time[0] + (time - time[0]) / 4
    )
    parts = _left_out(problem_of(fast, MODEL, {}), "f")
    assert _beyond(parts) == ("f",)


def test_the_two_are_judged_apart(warm: Problem) -> None:
    parts = _left_out(warm, "d", "f")
    inside, outside = apart(parts)
    assert (swept(parts, inside), _beyond(parts)) == (("d",), ("f",))
    start = Point(np.zeros(len(warm.constants)))
    found = extrapolation(parts, outside, (start, start, start), seed=0)
    assert found is not None
    alone = by_signal(_left_out(warm, "f").test, start)[Signal.FORCE]
    assert found.runs == ("f",)
    assert found.gaps[Signal.FORCE].after == pytest.approx(np.sqrt(np.mean(alone**2)))


def test_where_everything_left_out_is_beyond_it_is_the_test_as_well(
    warm: Problem,
) -> None:
    parts = _left_out(warm, "f")
    inside, outside = apart(parts)
    assert outside is not None
    assert swept(parts, inside) == swept(parts, outside) == ("f",)
