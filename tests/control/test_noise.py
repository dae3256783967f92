from random import Random

import pytest

from gripperd.control.frozen import Frozen
from gripperd.control.noise import Noise

PERIOD = 0.01


def learned(sigma: float, slope: float = 0.0, floor: float = 0.01) -> float:
    rng, noise = Random(1), Noise(floor)
    for step in range(6000):
        noise.update(slope * step * PERIOD + rng.gauss(0.0, sigma), PERIOD)
    return noise.sigma


@pytest.mark.parametrize("sigma", [0.05, 0.3])
def test_the_scatter_of_a_sensor_is_learned(sigma: float) -> None:
    assert learned(sigma) == pytest.approx(sigma, rel=0.15)


def test_a_steady_rise_is_no_noise() -> None:
    assert learned(0.05, slope=40.0) == pytest.approx(0.05, rel=0.15)


def test_a_quiet_sensor_is_never_trusted_beyond_its_span() -> None:
    assert learned(0.0) == 0.01


def test_a_spike_hardly_counts() -> None:
    rng, noise = Random(1), Noise(0.05)
    for step in range(2000):
        noise.update(rng.gauss(0.0, 0.05) + (1e3 if step == 1999 else 0.0), PERIOD)
    assert noise.sigma < 0.06


def stuck_after(frozen: Frozen, seconds: float) -> float | None:
    for step in range(round(seconds / PERIOD)):
        if frozen.update(5.0, PERIOD, resting=True):
            return (step + 1) * PERIOD
    return None


def test_a_sensor_with_noise_that_stops_is_stuck_within_half_a_second() -> None:
    rng, frozen = Random(1), Frozen()
    for _ in range(500):
        assert not frozen.update(rng.gauss(0.0, 1.0), PERIOD, resting=True)
    after = stuck_after(frozen, 2.0)
    assert after is not None
    assert after < 0.5


def test_a_coarse_sensor_that_often_repeats_itself_is_not_stuck() -> None:
    rng, frozen = Random(1), Frozen()
    # Rounded to two sigma it says the same about every second time.
    for _ in range(100_000):
        value = round(rng.gauss(0.0, 1.0) / 2.0)
        assert not frozen.update(value, PERIOD, resting=True)


def test_a_sensor_without_noise_is_never_stuck_at_rest() -> None:
    assert stuck_after(Frozen(), 600.0) is None
