from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.noise.model import Noise
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.dwell import drifted, dwelling, misfit
from gripperd.model.effect import Signal
from gripperd.model.track import Array
from tests.diagnose import stepped
from tests.diagnose.small import Moment, nothing
from tests.diagnose.stepped import DWELL, LENGTHS, PRESSURES, STEP, missed

START = Point(np.zeros(len(stepped.OPEN)))
IDENTIFIED = Noise(3.0, 0.0, 0.5, 20.0)
LEVEL = 20.0
"""Of the misfit. [N]"""


def _inflated(hidden: Callable[[Moment], Array] = nothing) -> Problem:
    plain = stepped.problem(hidden)
    return replace(plain, noises={**plain.noises, Signal.FORCE: Noise(LEVEL, 0.0)})


def _with(problem: Problem, change: Callable[[Array], Array]) -> Problem:
    """The same, were the force of each dwell other by a function of its time."""
    courses = list(problem.courses)
    for block in problem.dwells:
        course = courses[block.course]
        force = course.measured["force"].copy()
        time = course.time[block.good]
        force[block.good] += change(time - time[0])
        courses[block.course] = replace(
            course, measured={**course.measured, "force": force}
        )
    return replace(problem, courses=tuple(courses))


def test_a_dwell_lasts_from_a_second_after_a_command_to_the_next() -> None:
    problem = dwelling(_inflated(), START, IDENTIFIED)
    runs = len(LENGTHS) * len(PRESSURES)
    # Before its first command a run has been at rest for nobody knows how long.
    assert len(problem.dwells) == runs * (len(PRESSURES[0]) - 1)
    for number, block in enumerate(problem.dwells):
        course = problem.courses[block.course]
        since = course.time[block.good] - course.time[0]
        begin = DWELL * (1 + number % 3)
        assert since[0] == pytest.approx(begin + 1.0, abs=1.5 * STEP)
        assert since[-1] == pytest.approx(begin + DWELL, abs=3.5 * STEP)


def test_four_dwells_are_too_few() -> None:
    inflated = _inflated()
    once = replace(inflated, kept=tuple(
        (np.arange(len(c)) < 1.6 * DWELL / STEP) & (i < 4)
        for i, c in enumerate(inflated.courses)
    ))  # fmt: skip
    assert dwelling(once, START, IDENTIFIED) is once


def _sparse(problem: Problem, every: int, first: int = 0) -> Problem:
    """The same with but every so-many-th sample."""
    kept = tuple(np.arange(len(one)) % every == first for one in problem.courses)
    return replace(problem, kept=kept)


def _loudness(problem: Problem) -> float:
    """How loud the dwells are taken if the noise was thought to be half as loud. [N]"""
    (dwell, *_) = dwelling(problem, START, replace(IDENTIFIED, std=1.5)).dwells
    assert dwell.noise is not None
    return dwell.noise.std


def test_few_samples_are_as_loud_as_many() -> None:
    inflated = _inflated()
    # Of 8 or 9 samples a dwell a level and two ways of creeping take three.
    few = [_loudness(_sparse(inflated, 8, first)) for first in range(8)]
    assert np.mean(few) == pytest.approx(_loudness(inflated), rel=0.05)


def test_a_dwell_of_six_samples_is_none() -> None:
    sparse = _sparse(_inflated(), 12)
    assert dwelling(sparse, START, IDENTIFIED) is sparse


@pytest.mark.parametrize(
    ("name", "change", "fewer"),
    [
        ("contraction", 0.004, 0),
        ("contraction", 0.03, 3),
        ("pressure", 5e3, 0),
        ("pressure", 30e3, 3),
    ],
)
def test_what_moves_does_not_dwell(name: str, change: float, fewer: int) -> None:
    inflated = _inflated()
    first, *others = inflated.courses
    ramp = change * ((first.time - first.time[0]) % DWELL) / DWELL
    moving = replace(
        first,
        measured={**first.measured, name: first.level(name) + ramp},
        smooth={one: smooth for one, smooth in first.smooth.items() if one != name},
    )
    dwells = dwelling(
        replace(inflated, courses=(moving, *others)), START, IDENTIFIED
    ).dwells
    assert len(dwells) == 27 - fewer
    assert fewer == 0 or all(block.course > 0 for block in dwells)


def test_without_dwells_nothing_drifts() -> None:
    problem = _inflated()
    assert drifted(problem, START) == 0.0
    assert misfit(problem, START, Signal.FORCE) == 0.0


def test_the_level_of_a_dwell_costs_little_and_its_drift_much() -> None:
    problem = dwelling(_inflated(), START, IDENTIFIED)
    count = len(problem.dwells)
    base = misfit(problem, START, Signal.FORCE)
    levelled = misfit(_with(problem, lambda t: 0.0 * t + LEVEL), START, Signal.FORCE)
    drifting = misfit(_with(problem, lambda t: LEVEL * t / DWELL), START, Signal.FORCE)
    # One sigma of the level each.
    assert levelled - base == pytest.approx(count, rel=0.5)
    assert drifting - base > 20 * count


def test_dwells_are_as_loud_as_what_no_creep_explains() -> None:
    quiet = dwelling(_inflated(), START, IDENTIFIED).dwells[0].noise
    shaking = _inflated(lambda m: 9.0 * np.sin(40.0 * m.time))
    loud = dwelling(shaking, START, IDENTIFIED).dwells[0].noise
    crept = (
        dwelling(_inflated(stepped.creeping(0.05)), START, IDENTIFIED).dwells[0].noise
    )
    assert quiet is not None
    assert loud is not None
    assert crept is not None
    assert quiet.std == pytest.approx(3.0, rel=0.1)
    # A sine of 9 N beside noise of 3 N: (9² / 2 + 3²)^½.
    assert loud.std == pytest.approx(7.0, rel=0.15)
    assert crept.std == pytest.approx(quiet.std, rel=0.05)


def test_the_noise_of_a_dwell_wanders_as_it_was_identified() -> None:
    (first, *_) = dwelling(_inflated(), START, IDENTIFIED).dwells
    assert first.noise is not None
    assert first.noise.drift == LEVEL
    # Variance of the change over one second.
    apart = [
        2 * law.drift**2 * (1 - np.exp(-1.0 / law.memory))
        for law in (IDENTIFIED, first.noise)
    ]
    louder = (first.noise.std / IDENTIFIED.std) ** 2
    assert apart[1] == pytest.approx(louder * apart[0], rel=0.05)


def test_a_drift_is_told_from_a_level() -> None:
    problem = dwelling(_inflated(), START, IDENTIFIED)
    base = drifted(problem, START)
    assert drifted(_with(problem, lambda t: 0.0 * t + 50.0), START) == pytest.approx(
        base
    )
    slope = 4.0
    drifting = drifted(_with(problem, lambda t: slope * t), START)
    samples = sum(int(block.good.sum()) for block in problem.dwells)
    # The variance of a line of 4 N/s over the 7 s of a dwell.
    assert drifting - base == pytest.approx(samples * (slope * 7.0) ** 2 / 12, rel=0.1)


def test_misfit_is_all_levels_here() -> None:
    problem = dwelling(_inflated(missed), START, IDENTIFIED)
    samples = sum(int(block.good.sum()) for block in problem.dwells)
    assert misfit(problem, START, Signal.FORCE) == pytest.approx(samples, rel=0.1)
