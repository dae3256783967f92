from collections.abc import Sequence
from dataclasses import replace
from math import erfc

import numpy as np
import pytest

from gripperd.diagnose.noise.model import Noise
from gripperd.diagnose.residuals.holdout import split
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.verdict.where import LEVEL, PIECES, Finding, findings
from gripperd.model.effect import Signal
from gripperd.model.track import Array
from tests.diagnose.cycled import cut
from tests.diagnose.small import MODEL, moments, undoubted
from tests.diagnose.sweep import noise, run, triangle

STD, DRIFT = 3.0, 1.0


@pytest.fixture(scope="module")
def plain(blank: Problem) -> Problem:
    loud = {Signal.FORCE: Noise(STD, 0.0, drift=DRIFT)}
    return replace(undoubted(blank), noises=loud)


def _quiet(problem: Problem, seed: int = 0) -> list[Array]:
    """Noise as loud as is said, drift and all."""
    return [
        noise(time.size, STD, 100 * seed + place)
        for place, time in enumerate(problem.times)
    ]


def _found(problem: Problem, residuals: Sequence[Array]) -> tuple[Finding, ...]:
    return findings((problem, residuals))


def _off(problem: Problem, run: str, *biases: float) -> list[Array]:
    """Residuals of which stretches of one sweep are off by so much, else nothing."""
    residuals = [np.zeros(time.size) for time in problem.times]
    (index,) = (
        i for i, b in enumerate(problem.blocks) if problem.courses[b.course].run == run
    )
    cut = _halved(problem.times[index], residuals[index])
    for stretch, bias in zip(cut, biases, strict=True):
        stretch += bias
    return residuals


def _halved(time: Array, values: Array) -> list[Array]:
    """As many stretches of the way there as of the way back: all take as long."""
    halves = np.split(values, [np.searchsorted(time, (time[0] + time[-1]) / 2)])
    return [piece for half in halves for piece in np.array_split(half, PIECES // 2)]


def test_noise_is_nowhere_wrong(plain: Problem) -> None:
    assert sum(bool(_found(plain, _quiet(plain, seed))) for seed in range(10)) <= 1


def test_a_stretch_that_is_off_is_named_with_its_bias(plain: Problem) -> None:
    (found,) = _found(plain, _off(plain, "d", 0, 0, 20, 0, 0, 0, 0, 0))
    assert (found.run, found.signal, found.stage) == ("d", Signal.FORCE, "muscle")
    assert found.bias == pytest.approx(20.0)
    course = plain.courses[3]
    assert course.run == "d"
    low, high = found.region["time"]
    share = (np.array([low, high]) - course.time[0]) / np.ptp(course.time)
    np.testing.assert_allclose(share, [2 / 8, 3 / 8], atol=0.04)
    assert found.region["pressure"] == pytest.approx((200e3, 200e3), rel=0.03)
    # On the way there, so the contraction is 0.2 of twice the share of the time.
    np.testing.assert_allclose(found.region["contraction"], 0.4 * share, atol=2e-3)
    assert found.region["direction"] == (1.0, 1.0)


def test_the_standard_error_holds_noise_and_drift(plain: Problem) -> None:
    (found,) = _found(plain, _off(plain, "d", 0, 0, 20, 0, 0, 0, 0, 0))
    (samples,) = {
        _halved(time, time)[2].size
        for time, block in zip(plain.times, plain.blocks, strict=True)
        if plain.courses[block.course].run == "d"
    }
    assert found.std == pytest.approx((STD**2 / samples + DRIFT**2) ** 0.5)


def test_the_standard_error_holds_what_the_inputs_are_not_known_by(
    plain: Problem,
) -> None:
    courses = [
        replace(
            course,
            smooth={
                **course.smooth,
                "pressure": course.smooth["pressure"]._replace(doubt=20e3),
            },
        )
        if course.run == "d"
        else course
        for course in plain.courses
    ]
    doubtful = replace(plain, courses=tuple(courses))
    off = _off(plain, "d", 0, 0, 60, 0, 0, 0, 0, 0)
    (found,), (known,) = _found(doubtful, off), _found(plain, off)
    ((weighed, block),) = (
        (time, block)
        for time, block in zip(plain.times, plain.blocks, strict=True)
        if plain.courses[block.course].run == "d"
    )
    pressed = _halved(weighed, 20e3 * moments()["d"].pull_area[block.good])[2]
    told = (found.std**2 - known.std**2) * pressed.size
    assert told == pytest.approx(np.mean(pressed**2), rel=0.02)


def test_neighbours_that_are_off_the_same_way_are_one(plain: Problem) -> None:
    (found,) = _found(plain, _off(plain, "d", 0, 0, 20, 30, 0, 0, 0, 0))
    assert 20.0 < found.bias < 30.0


def test_neighbours_that_are_off_in_opposite_ways_are_two(plain: Problem) -> None:
    found = _found(plain, _off(plain, "d", 0, 0, 20, -30, 0, 0, 0, 0))
    assert [round(one.bias) for one in found] == [-30, 20]


def test_what_is_apart_stays_apart(plain: Problem) -> None:
    found = _found(plain, _off(plain, "d", 20, 0, 0, 0, 0, 0, 0, 20))
    assert len(found) == 2


def test_the_largest_comes_first(plain: Problem) -> None:
    residuals = [
        a + b
        for a, b in zip(
            _off(plain, "d", 0, 0, 20, 0, 0, 0, 0, 0),
            _off(plain, "b", 0, 0, 0, 0, -60, 0, 0, 0),
            strict=True,
        )
    ]
    assert [one.run for one in _found(plain, residuals)] == ["b", "d"]


@pytest.mark.parametrize(("apart", "size"), [(4, 5), (10, 4), (16, 5)])
def test_a_short_sweep_is_cut_into_fewer_stretches(
    plain: Problem, apart: int, size: int
) -> None:
    kept = tuple(np.arange(len(course)) % apart == 1 for course in plain.courses)
    short = replace(plain, kept=kept)
    residuals = [np.zeros(time.size) for time in short.times]
    ((left, time),) = (
        (residual, time)
        for residual, time, block in zip(
            residuals, short.times, short.blocks, strict=True
        )
        if plain.courses[block.course].run == "d"
    )
    # Of 23 samples two and three stretches, of 9 one each way, of 5 all of them.
    last = time.size - size
    left[last:] = 20.0
    (found,) = _found(short, residuals)
    assert (found.run, found.bias) == ("d", 20.0)
    assert found.region["time"] == (time[last], time[-1])


def test_chances_are_corrected_by_holm(plain: Problem) -> None:
    # Alternating signs, so that none are joined; the first are clear, the last not.
    biases = [12.0, -9.0, 6.0, -5.0, 4.5, -4.0, 3.5, -3.0]
    found = _found(plain, _off(plain, "d", *biases))
    cells = sum(min(PIECES, time.size // 4) for time in plain.times)
    assert cells == PIECES * len(plain.blocks)
    raw = []
    for block, time in zip(plain.blocks, plain.times, strict=True):
        if plain.courses[block.course].run == "d":
            for stretch, bias in zip(_halved(time, time), biases, strict=True):
                std = (STD**2 / stretch.size + DRIFT**2) ** 0.5
                raw.append(erfc(abs(bias) / std / 2**0.5))
    corrected = [
        max(min(1.0, p * (cells - rank)) for rank, p in enumerate(sorted(raw)[: k + 1]))
        for k in range(PIECES)
    ]
    kept = [p for p in corrected if p <= LEVEL]
    assert 0 < len(kept) < PIECES
    assert sorted(one.p_value for one in found) == pytest.approx(kept)


LOOP = 1.5


def _cycled(**columns: Array) -> tuple[Problem, Array]:
    """Ten cycles of 8 s, and 1 on the way there, -1 on the way back."""
    sweeps = cut(run("a", None, force=np.full(800, 100.0), **columns))
    problem = Problem(sweeps, MODEL, (), {Signal.FORCE: Noise(STD, 0.0)}, slack=-np.inf)
    return problem, np.tile(np.repeat([1.0, -1.0], 40), 10)


def _to_and_fro(low: float, high: float) -> Array:
    return np.tile(triangle(80, low, high), 10)


@pytest.mark.parametrize(
    ("columns", "name"),
    [
        (
            {"pressure": np.full(800, 2e5), "contraction": _to_and_fro(0.0, 0.2)},
            "direction",
        ),
        (
            {"pressure": _to_and_fro(1e5, 4e5), "contraction": np.zeros(800)},
            "pressure_direction",
        ),
    ],
)
def test_a_cycle_that_goes_on_is_off_by_its_loop(
    columns: dict[str, Array], name: str
) -> None:
    """Ways there and ways back are told apart: their mean is nothing."""
    problem, way = _cycled(**columns)
    (block,) = problem.blocks
    found = findings((problem, [LOOP * way[block.good]]))
    told = {one.region[name]: one.bias for one in found}
    assert told.keys() == {(1.0, 1.0), (-1.0, -1.0)}
    assert told[1.0, 1.0] == pytest.approx(LOOP, rel=0.05)
    assert told[-1.0, -1.0] == pytest.approx(-LOOP, rel=0.05)
    assert all(np.ptp(one.region["time"]) > 70.0 for one in found)


def test_what_was_left_out_is_looked_at_as_well(plain: Problem) -> None:
    parts = split(plain)
    off = [np.zeros(time.size) for time in parts.test.times]
    off[0] += 20.0
    found = findings((parts.train, _quiet(parts.train)), (parts.test, off))
    assert found[0].run == parts.test.courses[parts.test.blocks[0].course].run
    assert found[0].bias == pytest.approx(20.0)
