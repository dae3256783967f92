from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.noise.model import Noise
from gripperd.diagnose.residuals.block import Block
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.setup import problem_of
from gripperd.model.effect import Signal
from gripperd.model.track import Array
from tests.diagnose.small import (
    FORCE_NOISE,
    MODEL,
    PRESSURE_NOISE,
    moments,
    recording,
    undoubted,
    with_jaws,
)


@pytest.fixture
def start(blank: Problem) -> Point:
    return Point(np.zeros(len(blank.constants)))


@pytest.fixture
def truth(blank: Problem) -> Point:
    """The rig came to rest contracting, and its regulator follows at once."""
    built = {"rest": 1.0, "response": 0.0}
    shifts = [
        (built.get(one.path.partition(".")[0], one.nominal) - one.nominal) / one.sigma
        for one in blank.constants
    ]
    return Point(np.array(shifts))


def _of(problem: Problem, pieces: list[Array], signal: Signal) -> Array:
    return np.concatenate(
        [
            piece
            for block, piece in zip(problem.blocks, pieces, strict=True)
            if block.signal is signal
        ]
    )


def test_of_a_true_model_only_the_noise_is_left(blank: Problem, truth: Point) -> None:
    residuals = blank.residuals(truth)
    for signal, noise in (
        (Signal.FORCE, FORCE_NOISE),
        (Signal.PRESSURE, PRESSURE_NOISE),
    ):
        left = _of(blank, residuals, signal)
        assert np.std(left) == pytest.approx(noise, rel=0.2)
        assert abs(np.mean(left)) < 4 * noise / left.size**0.5


def test_whitened_it_has_unit_variance(blank: Problem, truth: Point) -> None:
    white = np.concatenate(
        [blank.white([r], i)[:, 0] for i, r in enumerate(blank.residuals(truth))]
    )
    assert np.mean(white**2) == pytest.approx(1.0, abs=0.12)


def test_a_signal_without_its_part_of_the_model_is_not_explained() -> None:
    told = with_jaws(recording())
    assert Signal.OPENING not in problem_of(told, MODEL, {}).signals
    bare = problem_of(told, replace(MODEL, regulator=None), {})
    assert bare.signals == (Signal.FORCE,)


def test_samples_that_are_not_kept_take_no_part(blank: Problem) -> None:
    masks = tuple(np.arange(len(course)) < 10 for course in blank.courses)
    part = replace(blank, kept=masks)
    assert part.signals == blank.signals
    assert all(time[-1] - time[0] < 2.5 for time in part.times)


def test_a_slack_muscle_tells_nothing(blank: Problem) -> None:
    taut = replace(blank, slack=100.0)
    force = _of(taut, taut.measured, Signal.FORCE)
    assert force.min() > 100.0 - 4 * FORCE_NOISE
    assert (
        _of(taut, taut.measured, Signal.PRESSURE).size
        == _of(blank, blank.measured, Signal.PRESSURE).size
    )


def test_where_a_force_sets_in_no_trend_makes_a_muscle_taut(blank: Problem) -> None:
    courses = []
    for course in blank.courses:
        trend = course.smooth["force"]._replace(value=np.full(len(course), 150.0))
        courses.append(replace(course, smooth={**course.smooth, "force": trend}))
    off = replace(blank, courses=tuple(courses), slack=100.0)
    assert _of(blank, blank.measured, Signal.FORCE).min() < 10.0
    assert _of(off, off.measured, Signal.FORCE).min() > 50.0


def test_the_full_scale_is_the_largest_reading(blank: Problem) -> None:
    # What is read where the pressure turns, at its highest, tells nothing.
    turn = [50, 51]
    readings = [np.delete(course.column("force"), turn) for course in blank.courses]
    top = float(np.max(np.concatenate(readings)))
    assert blank.full_scale[Signal.FORCE] == pytest.approx(top, rel=0.01)


def test_a_louder_noise_whitens_to_less(blank: Problem, start: Point) -> None:
    residual = blank.residuals(start)[0]
    signal = blank.blocks[0].signal
    twice = replace(blank, noises={**blank.noises, signal: Noise(2e3, 0.0)})
    once = replace(blank, noises={**blank.noises, signal: Noise(1e3, 0.0)})
    np.testing.assert_allclose(
        2 * twice.white([residual], 0), once.white([residual], 0), rtol=1e-6
    )


def test_a_wrong_constant_reaches_as_far_as_its_prior_lets_it(
    blank: Problem, start: Point
) -> None:
    paths = [one.path for one in blank.constants]
    diameter, zero = paths.index("muscle.diameter"), paths.index("zero.force")
    bound = blank.reach(start)
    freed = blank.reach(replace(start, freed=frozenset({diameter})))
    assert (bound[diameter], bound[zero]) == (3**0.5, 2.6)
    assert freed[diameter] == 2.6
    np.testing.assert_array_equal(
        np.delete(freed, diameter), np.delete(bound, diameter)
    )


def test_loosened_tolerances_were_searched_no_further(blank: Problem) -> None:
    start = Point(np.zeros(len(blank.constants)))
    freed = replace(start, freed=frozenset({0}))
    looser = replace(freed, looser=(2.0,) * len(blank.constants))
    assert blank.reach(freed)[0] > blank.reach(start)[0]
    assert blank.reach(looser)[0] == blank.reach(start)[0]


def _doubtful(blank: Problem, noise: Noise) -> tuple[Problem, Problem, float]:
    """One whose inputs are known, one without one pressure, and what that does. [N]."""
    alone = replace(undoubted(blank), noises={**blank.noises, Signal.FORCE: noise})
    doubt, courses = 10e3, list(alone.courses)
    place = next(i for i, course in enumerate(courses) if course.run == "a")
    pressure = courses[place].smooth["pressure"]
    smooth = {**courses[place].smooth, "pressure": pressure._replace(doubt=doubt)}
    courses[place] = replace(courses[place], smooth=smooth)
    handed = doubt * float(moments()["a"].pull_area[0])
    return alone, replace(alone, courses=tuple(courses)), handed


def _is_doubtful(problem: Problem, block: Block) -> bool:
    course = problem.courses[block.course]
    return course.run == "a" and block.signal is Signal.FORCE


def test_a_force_that_follows_from_a_doubtful_pressure_weighs_as_much_less(
    blank: Problem, start: Point
) -> None:
    std = 2.0
    alone, doubtful, handed = _doubtful(blank, Noise(std, 0.0))
    for index, (block, left) in enumerate(
        zip(alone.blocks, alone.residuals(start), strict=True)
    ):
        least = _is_doubtful(alone, block)
        weight = std / np.hypot(std, handed) if least else 1.0
        np.testing.assert_allclose(
            doubtful.white([left], index),
            weight * alone.white([left], index),
            rtol=0.02,
            atol=1e-6,
        )


def test_the_floor_is_that_of_all_that_is_compared(blank: Problem) -> None:
    alone, doubtful, handed = _doubtful(blank, Noise(3.0, 0.5, 4.0))
    assert alone.floor(Signal.FORCE) == pytest.approx(5.0)
    forces = [block for block in alone.blocks if block.signal is Signal.FORCE]
    counts = [int(block.good.sum()) for block in forces]
    own = [handed if _is_doubtful(alone, block) else 0.0 for block in forces]
    added = np.average(np.square(own), weights=counts)
    assert doubtful.floor(Signal.FORCE) == pytest.approx(
        (25.0 + added) ** 0.5, rel=0.01
    )
    pressure = doubtful.noises[Signal.PRESSURE]
    assert doubtful.floor(Signal.PRESSURE) == pytest.approx(pressure.floor)
