import numpy as np
import pytest

from gripperd.diagnose.noise.model import Noise, quick_noise
from gripperd.diagnose.noise.smoothing import Smooth
from gripperd.diagnose.readings.length import as_unsure, wandering
from gripperd.diagnose.readings.recording import Run
from gripperd.model.track import Array
from tests.diagnose.cycled import cut
from tests.diagnose.sweep import noise, run, triangle

SIZE = 400
HELD = np.full(SIZE, 0.1)
WANDERS, MEMORY, WHITE = 8e-4, 0.9, 3e-4
"""Standard deviations of what persists and of what does not, and how it does."""
SLOW = (WANDERS**2 * (1 + MEMORY) / (1 - MEMORY) + WHITE**2) ** 0.5
"""Of one sample as a mean over many has it: textbook, AR(1) beside white noise."""


def _read(way: Array, seed: int, opening: Array | None = None) -> Run:
    persistent = noise(way.size, WANDERS, seed, MEMORY)
    read = way + persistent + noise(way.size, WHITE, seed + 100)
    jaws = {} if opening is None else {"opening": opening}
    return run(f"r{seed}", None, contraction=read, **jaws)


def _neighbours(runs: list[Run]) -> Noise:
    return quick_noise([one.columns["contraction"] for one in runs])


def test_held_lengths_tell_how_far_their_noise_wanders() -> None:
    runs = [_read(HELD, seed) for seed in range(8)]
    told = _neighbours(runs)
    assert told.slow_variance**0.5 < 0.65 * SLOW
    assert wandering(runs, told).slow_variance ** 0.5 == pytest.approx(SLOW, rel=0.25)


def test_white_noise_does_not_wander() -> None:
    runs = [run(contraction=HELD + noise(SIZE, 5e-4, seed)) for seed in range(8)]
    told = _neighbours(runs)
    assert wandering(runs, told).slow_variance < 1.5 * told.slow_variance


@pytest.mark.parametrize(
    "way",
    [
        pytest.param(np.linspace(0.05, 0.08, 4000), id="a slow sweep"),
        pytest.param(0.1 - 0.05 * np.cos(np.linspace(0, 6.3, 4000)), id="a slow turn"),
    ],
)
def test_what_travels_slowly_does_not_wander(way: Array) -> None:
    runs = [run(contraction=way + noise(way.size, 5e-4, seed)) for seed in range(4)]
    told = _neighbours(runs)
    assert wandering(runs, told).slow_variance < 1.5 * told.slow_variance


def test_a_length_that_goes_with_its_force_does_not_wander() -> None:
    force = 50.0 * np.sin(np.linspace(0.0, 40.0, SIZE))
    way = HELD - 3e-5 * force
    runs = [
        run(contraction=way + noise(SIZE, 5e-4, seed), force=force) for seed in range(8)
    ]
    told = _neighbours(runs)
    assert wandering(runs, told).slow_variance < 1.5 * told.slow_variance


def test_a_muscle_that_moves_jaws_is_not_held() -> None:
    runs = [_read(HELD, seed, opening=HELD) for seed in range(8)]
    told = _neighbours(runs)
    assert wandering(runs, told) == told


def test_a_held_length_that_wanders_does_not_travel() -> None:
    yields = HELD[:160] - triangle(160, 0.0, 3e-3)
    courses = cut(*(_read(yields, seed) for seed in range(8)))
    assert not any(course.direction.any() for course in courses)


def test_a_trend_follows_no_more_than_there_is_of_a_wander() -> None:
    noisy = Noise(1e-3, 0.72, white=0.2)
    stiff = as_unsure(_trend(1e-5), noisy)
    assert stiff.spread == pytest.approx(1e-5 * (noisy.slow_variance / 1e-6) ** 0.5)
    supple = as_unsure(_trend(4e-4), noisy)
    assert supple.spread == pytest.approx((0.8e-6 + 0.16e-6) ** 0.5)
    assert as_unsure(_trend(4e-4), Noise(1e-3, 0.0)).spread == pytest.approx(4e-4)


def _trend(spread: float) -> Smooth:
    return Smooth(HELD, 0 * HELD, variance=1e-6, spread=spread)
