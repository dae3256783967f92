from itertools import pairwise, product

import numpy as np
import pytest
from scipy.stats import multivariate_normal

from gripperd.diagnose.noise.smoothing import OF_LENGTH, STIFFNESSES, smooth
from gripperd.diagnose.noise.trend import cheapest
from gripperd.model.track import Array
from tests.diagnose.sweep import noise

TIME = np.linspace(0.0, 12.0, 60)


def _covariance(time: Array, stiffness: float) -> Array:
    """Of a line of unknown level and slope plus an integrated Wiener process."""
    since = time - time[0]
    first, last = np.minimum.outer(since, since), np.maximum.outer(since, since)
    wander = first**2 * last / 2 - first**3 / 6
    return np.asarray(1e6 + 1e6 * np.outer(since, since) + stiffness * wander)


def _dense(column: Array, std: float) -> tuple[float, Array, Array]:
    """Best log density over all stiffnesses, and the posterior there: mean and std."""
    scaled = (column - column.mean()) / std
    size = column.size
    found: list[tuple[float, Array, Array]] = []
    for stiffness in STIFFNESSES.tolist():
        trend = _covariance(TIME, stiffness)
        law = multivariate_normal(np.zeros(size), trend + np.eye(size))
        density = float(law.logpdf(scaled)) + 0.5 * size * np.log(2 * np.pi)
        both = np.column_stack([scaled, trend])
        told = trend @ np.linalg.solve(trend + np.eye(size), both)
        mean, left = told[:, 0], np.sqrt(np.diag(trend - told[:, 1:]))
        found.append((density, mean * std + column.mean(), left * std))
    return max(found, key=lambda one: one[0])


def test_the_smoother_is_the_posterior_of_an_integrated_random_walk() -> None:
    column = 40.0 * np.sin(TIME) + noise(60, 2.0)
    density, mean, std = _dense(column, 2.0)
    known = smooth(TIME, column, 4.0)
    assert known.likelihood == pytest.approx(density, abs=0.01)
    np.testing.assert_allclose(known.value, mean, atol=0.01)
    np.testing.assert_allclose(known.doubt, std, rtol=0.01)


def test_of_a_noisy_line_little_but_the_line_is_left() -> None:
    line = 100.0 + 3.0 * TIME
    known = smooth(TIME, line + noise(60, 2.0), 4.0)
    assert np.sqrt(np.mean((known.value - line) ** 2)) < 0.5 * 2.0
    np.testing.assert_allclose(known.rate, 3.0, atol=0.3)


def test_the_rate_is_the_slope_of_the_value() -> None:
    known = smooth(TIME, 40.0 * np.sin(TIME) + noise(60, 0.5), 0.25)
    np.testing.assert_allclose(known.rate[3:-3], 40 * np.cos(TIME)[3:-3], atol=6.0)


def test_a_quick_motion_is_followed_whatever_the_clock() -> None:
    """From rest 3 % in a tenth of a second, read 40 times a second within 2e-4.

    By a clock that ran a hundred times slower it would be slow.
    """
    time = np.arange(0.0, 1.0, 0.025)
    way = 0.03 * np.clip((time - 0.5) / 0.1, 0.0, 1.0)
    read = way + noise(time.size, 2e-4)
    quick, slow = (
        smooth(by * time, read, 4e-8, tried=OF_LENGTH) for by in (1.0, 100.0)
    )
    assert np.sqrt(np.mean((quick.value - way) ** 2)) < 3e-4
    np.testing.assert_allclose(quick.value, slow.value, atol=3e-4)


def test_what_was_not_measured_is_bridged() -> None:
    line = 100.0 + 3.0 * TIME
    column = line + noise(60, 1.0)
    column[20:40] = np.nan
    known = smooth(TIME, column, 1.0)
    np.testing.assert_allclose(known.value[20:40], line[20:40], atol=1.5)


def test_a_supple_trend_keeps_a_corner_that_a_stiff_one_rounds() -> None:
    time = np.linspace(0.0, 12.0, 600)
    corner = 20.0 * np.abs(time - time[300])
    columns = [corner + noise(600, 1.0, seed) for seed in range(12)]
    stiff, supple = (
        float(np.mean([smooth(time, one, 1.0, s).value[300] for one in columns]))
        for s in (1.0, 1e4)
    )
    assert abs(supple) < 0.3 * abs(stiff)


def test_a_column_without_noise_stays_as_it_is() -> None:
    column = np.sin(TIME)
    known = smooth(TIME, column, 0.0)
    np.testing.assert_array_equal(known.value, column)
    np.testing.assert_allclose(known.rate[1:-1], np.cos(TIME)[1:-1], atol=0.01)


def test_a_column_nobody_measured_stays_unknown() -> None:
    known = smooth(TIME, np.full(60, np.nan), 1.0)
    assert np.isnan(known.value).all()


def test_a_single_sample_has_no_rate() -> None:
    known = smooth(np.zeros(1), np.array([7.0]), 1.0)
    assert (known.value.tolist(), known.rate.tolist()) == ([7.0], [0.0])


def _density(column: Array, std: float, stiffness: float) -> float:
    scaled = (column - column.mean()) / std
    covariance = _covariance(TIME, stiffness) + np.eye(column.size)
    return float(multivariate_normal(np.zeros(60), covariance).logpdf(scaled))


def test_it_tells_which_samples_in_a_row_leapt() -> None:
    time = np.arange(100.0)
    step = np.where(time < 50, 0.0, 100.0)
    stairs = step + np.where(time > 51, 100.0, 0.0) + np.where(time > 50, 100.0, 0.0)
    noise = np.random.default_rng(4).normal(0.0, 1.0, 100)
    assert smooth(time, noise, 1.0, leap=5.0).leapt == ()
    assert smooth(time, step + noise, 1.0, leap=5.0).leapt == (slice(50, 51),)
    assert smooth(time, stairs + noise, 1.0, leap=5.0).leapt == (slice(50, 53),)


def test_a_column_may_leap_from_its_first_sample() -> None:
    column = np.where(TIME[0] < TIME, 100.0, 0.0) + noise(60, 1.0)
    known = smooth(TIME, column, 1.0, leap=5.0)
    assert known.leapt == (slice(1, 2),)
    np.testing.assert_allclose(known.value[1:], 100.0, atol=1.5)


def test_a_column_of_one_reading_has_no_usual_rate() -> None:
    column = np.full(60, np.nan)
    column[7] = 3.0
    np.testing.assert_allclose(smooth(TIME, column, 1.0, leap=5.0).value, 3.0)


def test_leaps_in_a_row_are_a_way_at_a_rate() -> None:
    time = np.arange(0.0, 40.0, 0.1)
    way = 300.0 * np.clip(time - 20.0, 0.0, 1.0)
    noise = np.random.default_rng(4).normal(0.0, 1.0, time.size)
    leaping = smooth(time, way + noise, 1.0, leap=5.0)
    (row,) = leaping.leapt
    assert row.stop - row.start > 5
    assert leaping.rate[row] == pytest.approx(300.0, rel=0.1)
    assert np.abs(np.delete(leaping.rate, np.r_[row])).max() < 30.0


def test_a_reading_that_leaps_up_and_back_has_no_rate() -> None:
    time = np.arange(0.0, 40.0, 0.1)
    noise = np.random.default_rng(4).normal(0.0, 1.0, time.size)
    wrong = np.where(np.arange(time.size) == 200, 300.0, 0.0)
    leaping = smooth(time, noise + wrong, 1.0, leap=5.0)
    assert leaping.leapt
    assert np.abs(leaping.rate).max() < 5.0


def test_a_trend_that_may_bend_rests_between_the_corners_of_a_staircase() -> None:
    time = np.arange(0.0, 110.0, 0.2)
    levels = [0, 80, 160, 240, 320, 400, 320, 240, 160, 80]
    # Each of them for 10 s, and 1 s on the way to the next.
    ends = np.arange(10) * 11.0
    knots = np.column_stack([ends, ends + 10]).ravel()
    truth = np.interp(time, knots, np.repeat(levels, 2))
    column = truth + noise(time.size, 2.0)
    plain, bent = (smooth(time, column, 4.0, bends=one) for one in (False, True))
    assert bent.likelihood > plain.likelihood + 50
    flat = (time % 11 > 0.5) & (time % 11 < 9.5)
    cut, off = ((one.value - truth)[flat].std() for one in (plain, bent))
    assert off < 0.7 * cut
    assert off < 0.5 * 2.0


def test_what_does_not_bend_is_as_stiff_everywhere() -> None:
    column = 40.0 * np.sin(TIME) + noise(60, 2.0)
    plain, bent = (smooth(TIME, column, 4.0, bends=one) for one in (False, True))
    assert bent.likelihood == plain.likelihood
    np.testing.assert_array_equal(bent.value, plain.value)


@pytest.mark.parametrize("cost", [0.0, 0.7, 2.0, 9.0])
def test_the_cheapest_path_is_the_best_of_all(cost: float) -> None:
    densities = np.random.default_rng(5).normal(0.0, 1.0, (3, 7))

    def worth(path: tuple[int, ...]) -> float:
        changes = sum(a != b for a, b in pairwise(path))
        return float(densities[path, range(7)].sum()) - cost * changes

    best = max(worth(path) for path in product(range(3), repeat=7))
    assert worth(tuple(cheapest(densities, cost).tolist())) == pytest.approx(best)
