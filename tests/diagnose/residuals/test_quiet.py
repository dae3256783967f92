from collections.abc import Iterable, Mapping
from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.noise.drift import Quiet
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.residuals.quiet import repeated
from gripperd.model.effect import Signal
from gripperd.model.track import Array


def _missing(problem: Problem, lost: Mapping[str, Iterable[int]]) -> Problem:
    """The same without some samples of some sweeps."""
    kept = [
        ~np.isin(np.arange(len(course)), [*lost.get(course.run, ())])
        for course in problem.courses
    ]
    return replace(problem, kept=tuple(kept))


def _since(problem: Problem) -> list[Array]:
    """A residual that is the time since its sweep began: all repeats agree."""
    return [
        time - problem.courses[block.course].time[0]
        for time, block in zip(problem.times, problem.blocks, strict=True)
    ]


def _repeats(problem: Problem) -> list[Quiet]:
    indices = [i for i, b in enumerate(problem.blocks) if b.signal is Signal.FORCE]
    residuals = _since(problem)
    return [
        quiet
        for first in (True, False)
        for quiet in repeated(problem, residuals, indices, first=first)
    ]


def test_a_sweep_and_its_repeat_are_found(blank: Problem) -> None:
    (found,) = _repeats(blank)
    np.testing.assert_allclose(found.residual, 0.0, atol=1e-9)
    (course,) = (course for course in blank.courses if course.run == "b")
    assert np.isin(found.time, course.time).all()
    assert found.loudness == pytest.approx(2**0.5)


@pytest.mark.parametrize("run", ["b", "b2"])
def test_what_one_of_them_lacks_is_compared_with_nothing(
    blank: Problem, run: str
) -> None:
    (whole,) = _repeats(blank)
    lost = range(30, 40)
    (found,) = _repeats(_missing(blank, {run: lost}))
    np.testing.assert_allclose(found.residual, 0.0, atol=1e-9)
    (course,) = (course for course in blank.courses if course.run == "b")
    left = whole.time[~np.isin(whole.time, course.time[30:40])]
    np.testing.assert_array_equal(found.time, left)


def test_repeats_with_no_sample_in_common_tell_nothing(blank: Problem) -> None:
    torn = _missing(blank, {"b": range(0, 100, 2), "b2": range(1, 100, 2)})
    assert _repeats(torn) == []
