from collections.abc import Callable
from dataclasses import replace
from math import exp

import numpy as np
import pytest
from scipy.fft import dct
from scipy.stats import kstest

from gripperd.diagnose.noise.model import Noise
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.setup import problem_of
from gripperd.diagnose.verdict.structure import Structure, chi_square_tail, structures
from gripperd.diagnose.verdict.structure import _cosines as cosines
from gripperd.model.effect import Signal
from gripperd.model.track import Array
from tests.diagnose.small import LINKAGE, MODEL, STEP, recording, with_jaws
from tests.diagnose.sweep import noise

STD = 3.0


@pytest.fixture(scope="module")
def plain(blank: Problem) -> Problem:
    """The force alone, with white noise."""
    return replace(blank, noises={Signal.FORCE: Noise(STD, 0.0)})


def _residuals(
    problem: Problem,
    seed: int,
    shape: Callable[[Array, Array, Array], Array] = lambda p, h, d: 0.0 * p,
) -> list[Array]:
    """Noise plus a shape of pressure, contraction and direction."""
    found = []
    for place, block in enumerate(problem.blocks):
        course = problem.courses[block.course]
        levels = (course.level("pressure"), course.level("contraction"))
        more = shape(*levels, course.direction)[block.good]
        found.append(noise(more.size, STD, 100 * seed + place) + more)
    return found


def _first(
    problem: Problem, shape: Callable[[Array, Array, Array], Array]
) -> Structure:
    return structures(problem, _residuals(problem, 1, shape))[0]


@pytest.mark.parametrize("size", [30, 401])
def test_slow_components_are_those_of_the_cosine_transform(size: int) -> None:
    values = noise(size, 1.0)
    known = dct(values, type=2, norm="ortho")[:9]
    np.testing.assert_allclose(cosines(values, 9), known, atol=1e-9)


def test_few_samples_have_few_components() -> None:
    assert cosines(np.ones(9), 24).size == 3


@pytest.fixture(scope="module")
def chances(plain: Problem) -> dict[str, Array]:
    """Chances of every view, over many recordings of nothing but noise."""
    found: dict[str, list[float]] = {}
    for seed in range(60):
        for one in structures(plain, _residuals(plain, seed)):
            found.setdefault(one.along, []).append(one.p_value)
    return {along: np.array(values) for along, values in found.items()}


@pytest.mark.parametrize("along", ["time", "pressure", "contraction", "cells"])
def test_of_noise_the_chances_are_uniform(
    chances: dict[str, Array], along: str
) -> None:
    assert kstest(chances[along], "uniform").pvalue > 1e-3


@pytest.mark.parametrize("along", ["pressure x direction", "contraction x direction"])
def test_of_noise_the_chances_of_loops_are_uniform(
    chances: dict[str, Array], along: str
) -> None:
    assert kstest(chances[along], "uniform").pvalue > 1e-3


@pytest.mark.parametrize(
    ("shape", "along"),
    [
        pytest.param(
            lambda p, h, d: 4.0 * np.cos(np.pi * p / 250e3), "pressure", id="pressure"
        ),
        pytest.param(
            lambda p, h, d: 4.0 * np.sign(h - 0.1) * (np.ptp(h) > 0.1),
            "contraction",
            id="contraction",
        ),
        pytest.param(
            lambda p, h, d: 4.0 * d * np.sin(15 * h),
            "contraction x direction",
            id="loop",
        ),
    ],
)
def test_what_it_depends_on_comes_first(
    plain: Problem, shape: Callable[[Array, Array, Array], Array], along: str
) -> None:
    found = structures(plain, _residuals(plain, 1, shape))
    chances = {one.along: one.p_value for one in found}
    assert chances[along] < 1e-6
    assert chances[along] <= 1e3 * found[0].p_value


def test_views_come_most_significant_first(plain: Problem) -> None:
    found = structures(plain, _residuals(plain, 1, lambda p, h, d: p * 1e-5))
    chances = [one.p_value for one in found]
    assert chances == sorted(chances)


def test_its_size_is_that_of_what_is_there(plain: Problem) -> None:
    found = _first(plain, lambda p, h, d: np.full_like(p, 6.0))
    assert found.size * plain.full_scale[Signal.FORCE] == pytest.approx(6.0, rel=0.1)


def test_that_of_an_opening_counts_beside_the_length_that_it_follows() -> None:
    """A length that is off by as much of its range as the opening of its own."""
    model = replace(MODEL, linkage=LINKAGE)
    problem = problem_of(with_jaws(recording()), model, {})
    noises = {**problem.noises, Signal.OPENING: Noise(2e-4, 0.0)}
    residuals = [
        np.full(one.size, 1e-3 if block.signal is Signal.OPENING else 0.0)
        for block, one in zip(problem.blocks, problem.measured, strict=True)
    ]
    found = structures(replace(problem, noises=noises), residuals)
    (seen,) = (
        one for one in found if one.signal is Signal.OPENING and one.along == "time"
    )
    furthest = max(float(np.max(one.level("contraction"))) for one in problem.courses)
    both = problem.full_scale[Signal.OPENING] + 4 * 0.25 * furthest
    assert seen.size * both == pytest.approx(1e-3, rel=0.1)


def test_the_excess_is_what_noise_has_not(plain: Problem) -> None:
    found = _first(plain, lambda p, h, d: np.full_like(p, 6.0))
    samples = sum(time.size for time in plain.times)
    # Each sample adds (6 / 3)²; noise scatters the sum by a few per cent.
    assert found.excess == pytest.approx(4.0 * samples, rel=0.1)
    quiet = structures(plain, _residuals(plain, 2))
    assert abs(np.mean([one.excess for one in quiet if "x" not in one.along])) < 12.0


def test_a_fast_wave_counts_by_its_size_and_not_by_how_little_noise_is_there(
    blank: Problem,
) -> None:
    wandering = replace(blank, noises={Signal.FORCE: Noise(STD, 0.9)})
    waves = [STD * np.sin(2 * np.pi * 0.25 * t / STEP) for t in wandering.times]
    found = {one.along: one for one in structures(wandering, waves)}["time, at 1.0 Hz"]
    assert found.p_value < 1e-6
    assert found.size * wandering.full_scale[Signal.FORCE] == pytest.approx(
        STD / 2**0.5, rel=0.2
    )
    # Half the variance of one sample; such noise has 1.9 / 0.1 times it where slow.
    samples = sum(time.size for time in wandering.times)
    assert found.excess == pytest.approx(0.5 * samples * 0.1 / 1.9, rel=0.4)


def test_one_wave_holds_most_of_the_sum(plain: Problem) -> None:
    line = structures(plain, _residuals(plain, 1, lambda p, h, d: 6.0 + 0 * p))
    share = {one.along: one.share for one in line}
    quiet = {one.along: one.share for one in structures(plain, _residuals(plain, 1))}
    assert share["pressure"] > 0.9
    assert quiet["pressure"] < 0.5


def test_a_reading_is_not_looked_at_along_itself(blank: Problem) -> None:
    loud = replace(blank, noises={Signal.PRESSURE: Noise(1e3, 0.0)})
    views = {one.along for one in structures(loud, _residuals(loud, 1))}
    assert "current" in views
    assert "pressure" not in views


@pytest.mark.parametrize("total", [0.5, 4.0, 40.0])
def test_two_degrees_of_freedom_have_an_exponential_tail(total: float) -> None:
    assert chi_square_tail(total, 2) == pytest.approx(exp(-total / 2), rel=0.05)


def test_nothing_looked_at_proves_nothing() -> None:
    assert chi_square_tail(0.0, 0) == 1.0


@pytest.mark.parametrize(
    ("along", "sweeps", "wanders"),
    [
        ("time", 1, 0.003),
        ("pressure", 1, 0.003),
        ("time", 4, 0.003),
        ("pressure", 4, 0.0015),
        ("time, at 1.0 Hz", 1, 0.0),
    ],
)
def test_in_one_sweep_all_goes_with_time(
    plain: Problem, along: str, sweeps: int, wanders: float
) -> None:
    """The mean of four that wander on their own is half as far off as one."""
    few = replace(plain, courses=plain.courses[1 : 1 + sweeps])
    waves = [np.sin(2 * np.pi * 0.25 * t / STEP) for t in few.times]
    found = {one.along: one for one in structures(few, waves)}
    assert found[along].wanders == pytest.approx(wanders)
