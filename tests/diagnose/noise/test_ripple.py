import numpy as np
import pytest

from gripperd.diagnose.noise.model import Noise
from gripperd.diagnose.noise.ripple import _gain, ripple
from tests.diagnose.sweep import noise

STEP = 0.1
NOISE = Noise(3.0, 0.0)


def _times(*sizes: int) -> list[np.ndarray]:
    return [STEP * np.arange(size) for size in sizes]


def test_a_wave_is_found_with_its_frequency_and_its_size() -> None:
    times = _times(400, 300)
    waves = [noise(t.size, 1.0, t.size) + np.sin(2 * np.pi * 2.3 * t) for t in times]
    found = ripple(waves, times, NOISE)
    assert found.frequency == pytest.approx(2.3, abs=0.05)
    assert found.p_value < 1e-12
    # A sine of one standard deviation of the noise, 3 N, has 3 / root 2 N.
    assert found.amplitude == pytest.approx(3.0 / 2**0.5, rel=0.15)


def test_the_size_of_a_wave_is_its_own_root_mean_square() -> None:
    """An impulse has the flat spectrum of white noise, out of phase with a sine."""
    size, loud = 400, 0.5
    (time,) = _times(size)
    # Sum of squares of the impulse as of white noise of unit variance.
    flat = np.zeros(size)
    flat[0] = size**0.5
    wave = loud * np.sin(2 * np.pi * 2.0 * time)
    found = ripple([flat + wave], [time], NOISE)
    assert found.frequency == pytest.approx(2.0)
    assert found.amplitude == pytest.approx(3.0 * float(np.mean(wave**2)) ** 0.5)


def test_noise_has_no_wave() -> None:
    times = _times(*(20 * [300]))
    chances = [
        ripple(
            [noise(t.size, 1.0, 100 * s + i) for i, t in enumerate(times)], times, NOISE
        )
        for s in range(40)
    ]
    # One in ten would be expected below 0.1; the law of the largest is approximate.
    assert sum(one.p_value < 0.1 for one in chances) <= 10
    assert min(one.p_value for one in chances) > 1e-4


def test_what_a_slow_sweep_asks_for_is_no_wave() -> None:
    (time,) = _times(400)
    slow = noise(400, 1.0) + 5.0 * np.sin(2 * np.pi * time / 10.0)
    assert ripple([slow], [time], NOISE).p_value > 1e-3


@pytest.mark.parametrize("size", [0, 10])
def test_too_few_samples_tell_of_no_wave(size: int) -> None:
    found = ripple([np.ones(size)], _times(size), NOISE)
    assert found.p_value == 1.0
    assert found.amplitude == 0.0


def test_the_power_of_a_noise_is_the_transform_of_what_its_samples_share() -> None:
    """Wiener and Khinchin: the spectrum is the sum of all correlations as cosines."""
    law, cycles = Noise(3.0, 0.4, white=0.5), 0.17
    lags = np.arange(-400, 401)
    alike = np.where(lags == 0, 1.0, 0.5 * 0.8 ** np.abs(lags))
    power = 9.0 * np.sum(alike * np.cos(2 * np.pi * cycles * lags))
    assert _gain(law, cycles) == pytest.approx(power)


def test_noise_with_a_memory_swings_less_where_it_is_fast() -> None:
    times = _times(600)
    wave = [noise(600, 1.0) + np.sin(2 * np.pi * 4.0 * times[0])]
    # At 0.4 of the sampling rate an autoregressive noise of 0.5 has this power.
    power = (1 - 0.25) / (1 + 0.25 - np.cos(2 * np.pi * 0.4))
    plain, late = (ripple(wave, times, Noise(3.0, r)).amplitude for r in (0.0, 0.5))
    assert late / plain == pytest.approx(power**0.5, rel=1e-2)
