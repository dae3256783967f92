import numpy as np
import pytest

from gripperd.diagnose.noise.smoothing import OF_LENGTH, Smooth, smooth
from gripperd.diagnose.readings.travel import contracting
from gripperd.diagnose.readings.turn import Turned, turned
from gripperd.model.track import Array

STEP = 0.05
FAST = 0.016
"""Of a carriage. [1/s]"""


def _seen(way: Array, seed: int, std: float = 8e-4) -> tuple[Array, Array, Smooth]:
    """Time, readings with noise, and their trend."""
    time = STEP * np.arange(float(way.size))
    column = way + np.random.default_rng(seed).normal(0.0, std, way.size)
    return time, column, smooth(time, column, std**2, tried=OF_LENGTH)


def _told(way: Array, seed: int) -> tuple[Array, Turned]:
    time, column, known = _seen(way, seed)
    signs = contracting(known)
    return signs, turned(signs, time, column, known)


def _rested(rest: float) -> tuple[Array, float]:
    """There in 12 s, held for so long, and back; and when it leaves."""
    ends = np.cumsum([0.0, 1.0, 12.0, rest, 12.0, 1.0])
    time = np.arange(0.0, ends[-1], STEP)
    top = 12 * FAST
    return np.interp(time, ends, [0.0, 0.0, top, top, 0.0, 0.0]), float(ends[3])


def _turns(signs: Array) -> Array:
    places = 1 + np.flatnonzero(signs[1:] * signs[:-1] < 0)
    return STEP * places.astype(float)


@pytest.mark.parametrize("rest", [0.6, 1.0, 2.0])
def test_a_way_turns_at_the_end_of_its_rest(rest: float) -> None:
    """Every sample that is not left out lies on its own side of the turn."""
    way, left = _rested(rest)
    time = STEP * np.arange(float(way.size))
    truth = np.where(time < left, 1.0, -1.0)
    wrong, before = 0, 0
    for seed in range(20):
        plain, told = _told(way, seed)
        moved = plain != 0
        before += np.sum(moved & (plain != truth))
        wrong += np.sum(moved & ~told.unsure & (told.signs != truth))
    assert before > 20 * 3
    assert wrong < before / 4


@pytest.mark.parametrize("seed", range(4))
def test_of_a_long_rest_the_end_is_told(seed: int) -> None:
    way, left = _rested(2.0)
    _, told = _told(way, seed)
    np.testing.assert_allclose(_turns(told.signs), [left], atol=4 * STEP)
    assert told.unsure.sum() <= 1


@pytest.mark.parametrize("seed", range(4))
def test_a_round_turn_takes_no_rest(seed: int) -> None:
    time = np.arange(0.0, 28.0, STEP)
    way = 0.09 * (1 - np.cos(2 * np.pi * time / 28.0))
    _, told = _told(way, seed)
    np.testing.assert_allclose(_turns(told.signs), [14.0], atol=3 * STEP)
    assert told.unsure.sum() <= 3


def test_of_a_lopsided_turn_its_trend_knows_best() -> None:
    """Rounder where it comes than where it goes: half as round all over is too late."""
    time = np.arange(0.0, 28.0, STEP)
    way = 0.18 * np.sin(np.pi * (time / 28.0) ** 0.6) ** 2
    turn = 28.0 * 0.5 ** (1 / 0.6)
    off = [_turns(_told(way, seed)[1].signs).item() - turn for seed in range(10)]
    assert np.mean(np.abs(off)) < 3 * STEP


def _cornered(width: float, back: float) -> tuple[Array, float]:
    """There and back so many times as fast, smoothly; and when it turns."""
    fine, top = 0.005, 12 * FAST
    time = np.arange(0.0, 28.0, fine)
    sharp = np.interp(time, [0.0, 1.0, 13.0, 13.0 + 12 / back], [0.0, 0.0, top, 0.0])
    mean = np.ones(round(width / fine))
    blunt = np.convolve(sharp, mean / mean.sum(), "same")
    return blunt[:: round(STEP / fine)], float(time[np.argmax(blunt)])


@pytest.mark.parametrize("back", [1.0, 2.0])
@pytest.mark.parametrize("width", [0.3, 0.6, 1.2, 2.4])
def test_a_rounded_corner_takes_no_rest(width: float, back: float) -> None:
    """The faster the way back, the sooner it has undone what came."""
    way, turn = _cornered(width, back)
    time = STEP * np.arange(float(way.size))
    near = np.abs(time - turn) < 5.0
    for seed in range(10):
        _, told = _told(way, seed)
        sure = near & ~told.unsure & (np.abs(time - turn) > STEP)
        truth = np.where(time < turn, 1.0, -1.0)
        np.testing.assert_array_equal(told.signs[sure], truth[sure])
        assert told.unsure[near].sum() * STEP <= max(width, 0.4)


def test_a_way_back_that_halts_is_another_shape() -> None:
    """Neither a rest nor round: its trend knows best."""
    ends = np.array([0.0, 8.0, 8.4, 14.0, 20.0])
    time = np.arange(0.0, 20.0, STEP)
    plain, told = _told(np.interp(time, ends, [0.0, 0.1, 0.095, 0.095, 0.0]), 0)
    assert _turns(plain).size == 1
    np.testing.assert_array_equal(told.signs, plain)
    assert not told.unsure.any()


def test_of_a_few_readings_no_rest_is_told() -> None:
    ends = np.array([10, 15, 17, 22, 32])
    way = np.interp(np.arange(32), ends, [0.0, 0.1, 0.1, 0.0, 0.0])
    plain, told = _told(way, 1)
    assert _turns(plain).size > 0
    np.testing.assert_array_equal(told.signs, plain)
    assert not told.unsure.any()


def test_without_noise_there_is_nothing_to_mend() -> None:
    there = 1e-3 * np.arange(6.0)
    way = np.concatenate([there, np.full(4, there[-1]), there[::-1]])
    time = np.arange(float(way.size))
    signs = np.where(time < 7, 1.0, -1.0)
    told = turned(signs, time, way, Smooth(way, 0.0 * way))
    np.testing.assert_array_equal(told.signs, signs)


def test_readings_that_are_missing_leave_it_as_it_is() -> None:
    way, _ = _rested(1.0)
    time, column, known = _seen(way, 1)
    column[7] = np.nan
    signs = contracting(known)
    np.testing.assert_array_equal(turned(signs, time, column, known).signs, signs)
