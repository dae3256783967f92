import numpy as np
import pytest
from scipy.linalg import toeplitz

from gripperd.diagnose.noise.model import Noise, coarse_step, quick_noise
from tests.diagnose.sweep import noise

SIZE = 20_000


@pytest.mark.parametrize("correlation", [0.0, 0.3, 0.6])
def test_autoregressive_noise_is_measured(correlation: float) -> None:
    found = quick_noise([noise(SIZE, 2.5, memory=correlation)])
    assert found.std == pytest.approx(2.5, rel=0.05)
    assert found.correlation == pytest.approx(correlation, abs=0.05)


def test_what_moves_slowly_is_no_noise() -> None:
    slow = 300.0 * np.sin(np.linspace(0.0, 60.0, SIZE))
    found = quick_noise([slow + noise(SIZE, 2.5)])
    assert found.std == pytest.approx(2.5, rel=0.05)


def test_steps_and_spikes_are_no_noise() -> None:
    column = noise(SIZE, 2.5)
    column[5000:] += 400.0
    column[::500] += 100.0
    assert quick_noise([column]).std == pytest.approx(2.5, rel=0.05)


def test_differences_between_runs_are_no_noise() -> None:
    pieces = [noise(500, 2.5, seed) + 1000.0 * seed for seed in range(40)]
    assert quick_noise(pieces).std == pytest.approx(2.5, rel=0.05)


@pytest.mark.parametrize("size", [4, 5, 6, 7, 8])
def test_many_short_pieces_tell_of_their_noise(size: int) -> None:
    slope = 40.0 * np.arange(size)
    pieces = [slope + noise(size, 2.5, seed) + seed for seed in range(600)]
    found = quick_noise(pieces)
    # 600 pieces of four, without their means and slopes, leave a standard error of 2 %.
    assert found.std == pytest.approx(2.5, rel=0.035)
    assert found.correlation == 0.0


@pytest.mark.parametrize("correlation", [0.0, 0.3, 0.6])
@pytest.mark.parametrize("size", [9, 12, 16])
def test_pieces_of_a_dozen_samples_tell_of_its_memory(
    size: int, correlation: float
) -> None:
    slope = 40.0 * np.arange(size)
    noises = [noise(size, 2.5, seed, memory=correlation) for seed in range(600)]
    found = quick_noise([slope + one for one in noises])
    assert found.std == pytest.approx(2.5, rel=0.1)
    assert found.correlation == pytest.approx(correlation, abs=0.1)


def test_short_pieces_say_nothing_of_the_spread_beside_a_long_one() -> None:
    piece = noise(SIZE, 2.5)
    jumps = [np.array([0.0, 900.0, 0.0, -900.0, 900.0])] * 100
    assert quick_noise([piece, *jumps]).std == pytest.approx(2.5, rel=0.05)


def test_short_pieces_that_repeat_one_reading_leave_the_resolution() -> None:
    steady = [np.full(6, 2.0), np.full(6, 2.4)]
    assert quick_noise(steady).std == pytest.approx(0.4 / 12**0.5)


def test_missing_samples_are_left_out() -> None:
    column = noise(SIZE, 2.5)
    column[::7] = np.nan
    assert quick_noise([column]).std == pytest.approx(2.5, rel=0.05)


def test_a_wave_is_not_taken_for_a_strong_correlation() -> None:
    wave = 100.0 * np.sin(2 * np.pi * np.arange(SIZE) / 40.0)
    assert quick_noise([wave + noise(SIZE, 2.5)]).correlation < 0.35


def test_without_noise_the_resolution_of_the_converter_remains() -> None:
    steady = [np.full(50, 2.0), np.full(50, 2.4)]
    # A uniform law of width 0.4 has a standard deviation of 0.4 / root 12.
    assert quick_noise(steady).std == pytest.approx(0.4 / 12**0.5)
    assert quick_noise(steady).correlation == 0.0


def test_steps_are_no_noise_though_a_coarse_converter_repeats_most_readings() -> None:
    held = 0.8 * np.round(noise(SIZE, 0.35) / 0.8)
    jumps = np.where(np.arange(SIZE) % 100 < 4, noise(SIZE, 60.0, 1), 0.0)
    assert np.mean(np.diff(held) == 0) > 0.5
    step = coarse_step([held + jumps])
    assert step == pytest.approx(0.8)
    found = quick_noise([held + jumps], step)
    assert found.std == pytest.approx(float(held.std()), rel=0.2)


def test_a_coarse_converter_is_as_noisy_on_a_slope_as_at_rest() -> None:
    step = 500 / 255
    true = 0.6 * step * np.arange(SIZE)
    read = np.round(step * np.round((true + noise(SIZE, 0.3)) / step), 3)
    both_ways = [read, read[::-1]]
    assert np.mean(np.diff(read) == 0) < 0.5
    found = quick_noise(both_ways, coarse_step(both_ways))
    assert 1.0 < found.std / np.std(read - true) < 1.5


def test_set_points_far_apart_are_no_steps_of_a_converter() -> None:
    """Readings of a table, some of which come again within the display of a meter."""
    table = np.repeat(np.arange(0.0, 600.0, 50.0), 3)
    table[4::9] += 0.1
    assert coarse_step([table, table[::-1]]) == pytest.approx(0.1)


def test_a_fine_converter_has_no_step_to_speak_of() -> None:
    rests = noise(SIZE, 2.5)
    assert coarse_step([rests]) == 0.0
    rests[:200], rests[200:400] = 0.0, 50.0
    assert coarse_step([rests]) == 0.0
    assert coarse_step([np.full(50, 2.0)]) == 0.0
    assert coarse_step([]) == 0.0


def test_nothing_measured_has_no_noise() -> None:
    assert quick_noise([]) == Noise(0.0, 0.0)
    assert quick_noise([np.full(9, np.nan)]) == Noise(0.0, 0.0)


def test_the_slow_variance_is_what_a_long_mean_sees() -> None:
    size = 1000
    law = Noise(3.0, 0.5)
    covariance = 9.0 * toeplitz(0.5 ** np.arange(size))
    assert law.slow_variance == pytest.approx(covariance.sum() / size, rel=0.005)


def test_what_is_white_is_shared_with_no_other_sample() -> None:
    """Half the variance persists by 0.8: neighbours share 0.4, the next ones 0.32."""
    size = 1000
    law = Noise(3.0, 0.4, white=0.5)
    alike = np.r_[1.0, 0.5 * 0.8 ** np.arange(1, size)]
    np.testing.assert_allclose(law.correlations(np.arange(float(size))), alike)
    covariance = 9.0 * toeplitz(alike)
    assert law.slow_variance == pytest.approx(covariance.sum() / size, rel=0.01)


def test_the_floor_holds_noise_and_drift() -> None:
    assert Noise(3.0, 0.5, drift=4.0).floor == pytest.approx(5.0)


def test_a_transmitter_that_averages_is_no_louder_than_all_it_reads() -> None:
    """Neighbours share half of their noise, the next but one nothing at all."""
    own = noise(SIZE, 2.5)
    found = quick_noise([(own[1:] + own[:-1]) / 2])
    assert found.std == pytest.approx(2.5 / 2**0.5, rel=0.1)
    assert found.correlation == pytest.approx(0.5, abs=0.1)
