"""Lengths that are held."""

import numpy as np
import pytest
from scipy.ndimage import uniform_filter1d

from gripperd.diagnose.noise.smoothing import Smooth
from gripperd.diagnose.readings.rest import at_rest
from gripperd.model.track import Array
from tests.diagnose.sweep import noise, triangle

SIZE, STD, MEMORY = 450, 1e-3, 0.5


def _held(true: Array, seed: int = 1) -> Array:
    """Level of a length read with noise that remembers, about a trend 31 wide."""
    column = true + noise(SIZE, STD, seed, MEMORY)
    variance = STD**2 * (1 + MEMORY) / (1 - MEMORY)
    trend = uniform_filter1d(column, 31)
    spread = (variance / 31) ** 0.5
    known = Smooth(trend, np.gradient(trend), variance=variance, spread=spread)
    return at_rest(column, known)


@pytest.mark.parametrize("seed", range(5))
def test_a_carriage_that_comes_to_its_length_leaves_none_of_it_elsewhere(
    seed: int,
) -> None:
    """Six seconds at 0.6 % less; the mean of all would be off by 8e-4."""
    true = np.where(np.arange(SIZE) < 60, -0.006, 0.0)
    found = _held(true, seed)
    assert np.unique(found).size == 2
    # Three standard errors of a mean.
    assert found[62:] == pytest.approx(0.0, abs=3e-4)
    assert found[:58] == pytest.approx(-0.006, abs=7e-4)


@pytest.mark.parametrize("seed", range(20))
def test_noise_alone_shifts_nothing(seed: int) -> None:
    assert np.ptp(_held(np.zeros(SIZE), seed)) == 0


def test_a_shift_by_less_than_turns_a_length_round_is_none() -> None:
    true = np.where(np.arange(SIZE) < SIZE // 2, -0.0014, 0.0)
    assert np.ptp(_held(true)) == 0


def test_what_gives_way_and_comes_back_shifts_nothing() -> None:
    """A frame under a load goes there and back, as its trend says."""
    assert np.ptp(_held(triangle(SIZE, 0.0, 8e-3))) == 0


def test_a_single_reading_far_away_shifts_nothing() -> None:
    true = np.zeros(SIZE)
    true[2] = -0.02
    assert np.ptp(_held(true)) == 0
