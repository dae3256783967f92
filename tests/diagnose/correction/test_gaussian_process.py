"""The textbook formulas, each written out plainly, are the oracle."""

import numpy as np
import pytest
from scipy.optimize import approx_fprime
from scipy.stats import multivariate_normal

from gripperd.diagnose.correction.gaussian_process import (
    Kernel,
    Process,
    Samples,
    _misfit,
    likeliest,
)
from gripperd.model.track import Array

RANDOM = np.random.default_rng(5)
INPUTS = RANDOM.uniform(-2.0, 2.0, (60, 2))
NOISE = 0.05


def _wave(inputs: Array) -> Array:
    return np.asarray(3.0 * np.sin(2.0 * inputs[:, 0]))


OUTCOME = _wave(INPUTS) + NOISE * RANDOM.normal(size=60)
KERNEL = Kernel(2.0, np.array([0.7, 4.0]))


def _correlated() -> Array:
    pairs = np.abs(np.subtract.outer(np.arange(60), np.arange(60)))
    return np.asarray(np.exp(-pairs / 5.0))


def _samples(wander: Array | None = None) -> Samples:
    slow = np.eye(60) if wander is None else wander
    return Samples(INPUTS, OUTCOME, NOISE**2 * np.eye(60), slow)


def _process() -> Process:
    features = KERNEL.between(INPUTS, INPUTS) / NOISE
    return Process.given(KERNEL, INPUTS, features, OUTCOME / NOISE)


def _plain(kernel: Kernel, one: Array, other: Array) -> Array:
    return np.array(
        [
            [
                kernel.amplitude**2
                * np.exp(-0.5 * sum(((a - b) / kernel.lengths) ** 2))
                for b in other
            ]
            for a in one
        ]
    )


def test_the_covariance_is_the_squared_exponential() -> None:
    found = KERNEL.between(INPUTS[:5], INPUTS[5:9])
    assert found == pytest.approx(_plain(KERNEL, INPUTS[:5], INPUTS[5:9]))


def test_the_misfit_is_the_density_of_the_outcome() -> None:
    def misfit(amplitude: float) -> float:
        logs = np.log([amplitude, 0.7, 4.0, 0.3])
        return _misfit(_samples(), logs)[0]

    def density(amplitude: float) -> float:
        kernel = Kernel(amplitude, KERNEL.lengths)
        whole = _plain(kernel, INPUTS, INPUTS) + (NOISE**2 + 0.3**2) * np.eye(60)
        return float(multivariate_normal(np.zeros(60), whole).logpdf(OUTCOME))

    assert misfit(2.0) - misfit(1.0) == pytest.approx(
        density(1.0) - density(2.0), rel=1e-4
    )


def test_the_slope_is_that_of_the_misfit() -> None:
    samples = _samples(_correlated())
    logs = np.log([2.0, 0.7, 4.0, 0.3])

    def misfit(there: Array) -> float:
        return _misfit(samples, there)[0]

    slope = approx_fprime(logs, misfit, 1e-6)
    assert _misfit(samples, logs)[1] == pytest.approx(slope, rel=1e-3, abs=1e-3)


def test_what_does_not_matter_gets_the_longest_length() -> None:
    kernel, wander = likeliest(_samples())
    assert kernel.lengths[1] > 20.0
    assert kernel.lengths[0] < 2.0
    assert wander < 0.3


def test_what_does_not_come_again_is_wander_and_no_function() -> None:
    slow = _correlated()
    drawn = np.linalg.cholesky(slow) @ np.random.default_rng(8).normal(size=60)
    kernel, wander = likeliest(Samples(INPUTS, drawn, NOISE**2 * np.eye(60), slow))
    assert wander == pytest.approx(1.0, abs=0.3)
    assert kernel.amplitude < 0.3


def test_the_mean_is_that_of_regression_on_all_the_data() -> None:
    there = np.array([[0.3, 0.0], [1.1, -1.0]])
    whole = _plain(KERNEL, INPUTS, INPUTS) + NOISE**2 * np.eye(60)
    expected = _plain(KERNEL, there, INPUTS) @ np.linalg.solve(whole, OUTCOME)
    assert _process().mean(there) == pytest.approx(expected, abs=1e-4)
    assert expected == pytest.approx(_wave(there), abs=0.3)


def test_the_doubt_is_the_posterior_variance_over_the_prior() -> None:
    there = np.array([[0.3, 0.0], [2.4, 6.0]])
    whole = _plain(KERNEL, INPUTS, INPUTS) + NOISE**2 * np.eye(60)
    near = _plain(KERNEL, there, INPUTS)
    known = np.sum(near * np.linalg.solve(whole, near.T).T, axis=1)
    expected = 1 - known / KERNEL.amplitude**2
    assert _process().doubt(there) == pytest.approx(expected, abs=1e-4)


def test_data_may_tell_far_more_than_is_known_before() -> None:
    """A noise of a millionth of the function, and readings side by side."""
    twice = np.concatenate([INPUTS, INPUTS + 1e-3])
    outcome, noise = _wave(twice), 2e-6
    features = KERNEL.between(twice, twice) / noise
    process = Process.given(KERNEL, twice, features, outcome / noise)
    assert process.mean(INPUTS) == pytest.approx(_wave(INPUTS), abs=0.01)
    assert process.doubt(INPUTS) == pytest.approx(0.0, abs=1e-4)


def test_far_from_data_nothing_is_known() -> None:
    far = np.array([[40.0, 0.0]])
    assert _process().doubt(far) == pytest.approx([1.0])
    assert _process().mean(far) == pytest.approx([0.0])
