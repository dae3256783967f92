import numpy as np
import pytest

from gripperd.diagnose.noise.drift import (
    Quiet,
    coloured,
    hold,
    repeat,
    shortened,
    with_drift,
)
from gripperd.diagnose.noise.drift import _likelihood as restricted
from gripperd.diagnose.noise.model import Noise, quick_noise
from gripperd.model.track import Array
from tests.diagnose.sweep import noise

TIME: Array = 0.25 * np.arange(800.0)
QUICK = Noise(2.0, 0.0)
FULL_SCALE = 1000.0
MOST = 10.0


def _wander(std: float, memory: float, seed: int) -> Array:
    return noise(TIME.size, std, seed, float(np.exp(-0.25 / memory)))


def _holds(std: float, memory: float = 20.0) -> list[Quiet]:
    return [
        hold(
            TIME, _wander(std, memory, seed) + noise(800, 2.0, 50 + seed), creeps=False
        )
        for seed in range(4)
    ]


@pytest.mark.parametrize("size", [0.001, 0.002])
def test_the_size_of_a_drift_is_read_off_holds(size: float) -> None:
    found = with_drift(QUICK, _holds(size * FULL_SCALE), FULL_SCALE)
    assert found.drift == pytest.approx(size * FULL_SCALE, rel=0.55)


def test_a_sensor_that_does_not_drift_gets_the_least() -> None:
    still = with_drift(QUICK, _holds(1e-9), FULL_SCALE)
    assert still.drift <= 5e-4 * FULL_SCALE


def test_a_slow_drift_is_remembered_longer_than_a_quick_one() -> None:
    quick, slow = (
        with_drift(QUICK, _holds(2.0, memory), FULL_SCALE).memory
        for memory in (6.0, 150.0)
    )
    assert quick < slow


def test_the_noise_of_neighbours_is_kept() -> None:
    found = with_drift(Noise(2.0, 0.3), _holds(1.0), FULL_SCALE)
    assert (found.std, found.correlation) == (2.0, 0.3)


@pytest.mark.parametrize(("persistence", "share"), [(0.8, 0.3), (0.7, 0.6), (0.9, 0.5)])
def test_what_persists_under_white_noise_is_found_in_holds(
    persistence: float, share: float
) -> None:
    holds = [
        hold(
            TIME,
            noise(800, 2.0 * share**0.5, seed, persistence)
            + noise(800, 2.0 * (1 - share) ** 0.5, 50 + seed),
            creeps=False,
        )
        for seed in range(4)
    ]
    neighbours = quick_noise([each.residual for each in holds])
    true = Noise(2.0, share * persistence, white=1 - share)
    found = coloured(neighbours, holds, MOST)
    assert found.slow_variance == pytest.approx(true.slow_variance, rel=0.4)
    assert neighbours.slow_variance < 0.6 * true.slow_variance


@pytest.mark.parametrize("correlation", [0.0, 0.3, 0.6])
def test_noise_that_is_known_by_its_neighbours_stays_as_it_is(
    correlation: float,
) -> None:
    law = Noise(2.0, correlation)
    holds = [
        hold(TIME, noise(800, 2.0, s, correlation), creeps=False) for s in range(4)
    ]
    assert coloured(law, holds, MOST) == law


def test_few_samples_tell_no_colour() -> None:
    long = hold(TIME, noise(800, 2.0, 0, 0.9) + noise(800, 2.0, 50), creeps=False)
    law = quick_noise([long.residual])
    assert coloured(law, [long], MOST) != law
    assert coloured(law, shortened([long], 190), MOST) == law


def test_what_wanders_more_than_any_sensor_is_no_noise() -> None:
    holds = [
        hold(TIME, noise(800, 15.0, s, 0.8) + noise(800, 2.0, 50 + s), creeps=False)
        for s in range(4)
    ]
    neighbours = quick_noise([each.residual for each in holds])
    assert coloured(neighbours, holds, MOST) == neighbours
    assert coloured(neighbours, holds, 2 * MOST) != neighbours


def test_without_a_hold_some_drift_is_assumed() -> None:
    assert 0 < with_drift(QUICK, [], FULL_SCALE).drift < 0.005 * FULL_SCALE


@pytest.mark.parametrize(
    "motion",
    [
        pytest.param(500.0 + 0 * TIME, id="offset"),
        pytest.param(300.0 * np.log1p(TIME), id="creep"),
    ],
)
def test_what_may_move_in_a_hold_is_no_drift(motion: Array) -> None:
    rest = _wander(1.0, 20.0, 1) + noise(800, 2.0, 2)
    plain, moving = (hold(TIME, rest + way, creeps=True) for way in (0.0, motion))
    assert with_drift(QUICK, [plain], 1e3) == with_drift(QUICK, [moving], 1e3)


def test_a_loss_between_repeats_is_no_drift() -> None:
    load = np.sin(TIME / 30) ** 2
    first, second = (_wander(1.0, 20.0, s) + noise(800, 2.0, s + 9) for s in (1, 2))
    plain = repeat(TIME, first, second, load)
    lossy = repeat(TIME, first, second - 80.0 * load + 5.0, load)
    assert with_drift(QUICK, [plain], 1e3) == with_drift(QUICK, [lossy], 1e3)


def test_the_score_is_the_restricted_likelihood() -> None:
    law = Noise(2.0, 0.0, drift=3.0, memory=15.0)
    quiet = hold(TIME[:60], noise(60, 3.0), creeps=True)
    x = quiet.regressors
    apart = np.abs(np.subtract.outer(quiet.time, quiet.time))
    covariance = 4.0 * np.eye(60) + 9.0 * np.exp(-apart / 15.0)
    inverse = np.linalg.inv(covariance)
    within = x.T @ inverse @ x
    left = inverse - inverse @ x @ np.linalg.solve(within, x.T @ inverse)
    score = -0.5 * (
        quiet.residual @ left @ quiet.residual
        + np.linalg.slogdet(covariance)[1]
        + np.linalg.slogdet(within)[1]
    )
    assert restricted(law, quiet) == pytest.approx(score, rel=1e-6)


def test_a_difference_of_repeats_is_louder_than_one_sweep() -> None:
    one, other = noise(800, 2.0, 1), noise(800, 2.0, 2)
    found = repeat(TIME, one, other, np.sin(TIME))
    np.testing.assert_allclose(found.residual, other - one)
    assert np.std(found.residual) / 2.0 == pytest.approx(found.loudness, rel=0.05)


def test_a_constant_load_is_no_second_constant() -> None:
    assert repeat(TIME, TIME, TIME, np.full(800, 3.0)).regressors.shape == (800, 1)


def test_long_stretches_are_cut() -> None:
    (short,) = shortened([hold(TIME, TIME, creeps=True)], most=100)
    assert (short.time.size, short.residual.size) == (100, 100)
    assert short.regressors.shape == (100, 3)
