"""A Gaussian process: a smooth function of several quantities, known near its data.

References
----------
.. [1] C. E. Rasmussen, C. K. I. Williams, "Gaussian Processes for Machine Learning",
       MIT Press, 2006: eqs. (5.8) and (5.9) for the marginal likelihood and its slope,
       section 5.1 for a length per quantity, section 8.3.4 for projected processes,
       section 3.4.3 for roots of what has no eigenvalue below 1.
"""

from dataclasses import dataclass
from functools import partial

import numpy as np
from scipy.linalg import cho_factor, cho_solve, cholesky, solve_triangular
from scipy.optimize import Bounds, OptimizeResult, minimize
from scipy.spatial.distance import cdist

from gripperd.diagnose.side_by_side import side_by_side
from gripperd.model.track import Array

LENGTHS = (0.03, 30.0)
"""Shortest and longest length, in standard deviations of a quantity; at the longest
the function does not depend on it."""
STARTS = (1.0, 0.2)
"""Lengths from which the likeliest are searched."""
SIZES = (1e-3, 1e2)
"""Least and largest standard deviation, in root mean squares of the outcome."""
STEPS = 60
"""Of each search; lengths to a few per cent are enough."""
JITTER = 1e-8
"""Added to a diagonal so that rounding cannot make it indefinite, of the variance."""


@dataclass(frozen=True, slots=True)
class Kernel:
    """Squared exponential covariance."""

    amplitude: float
    """Standard deviation of the function where nothing is known."""
    lengths: Array
    """Way along each quantity over which it changes, shape ``(k,)``."""

    def between(self, one: Array, other: Array) -> Array:
        """Covariance of shapes ``(n, k)`` and ``(m, k)``, shape ``(n, m)``."""
        apart = cdist(one / self.lengths, other / self.lengths, "sqeuclidean")
        return np.asarray(self.amplitude**2 * np.exp(-0.5 * apart))


@dataclass(frozen=True, slots=True)
class Samples:
    """What a function and its noise are learnt from."""

    inputs: Array
    """Of unit spread, shape ``(n, k)``."""
    outcome: Array
    """Shape ``(n,)``."""
    noise: Array
    """Covariance of the noise, shape ``(n, n)``."""
    wander: Array
    """Correlation of what is no function of the inputs, shape ``(n, n)``."""


def likeliest(samples: Samples, processes: int = 1) -> tuple[Kernel, float]:
    """Give the kernel of the largest marginal likelihood, and the size of the wander.

    Everything is positive, so it is searched in logarithms.

    Parameters
    ----------
    samples
        What it is learnt from.
    processes
        How many share the searches.
    """
    size = float(np.sqrt(np.mean(samples.outcome**2))) or 1.0
    count = samples.inputs.shape[1]
    low, high = (
        np.log([size * end, *[length] * count, size * end])
        for end, length in zip(SIZES, LENGTHS, strict=True)
    )

    def searched(start: float) -> OptimizeResult:
        return minimize(
            partial(_misfit, samples),
            np.log([size, *[start] * count, 0.3 * size]),
            jac=True,
            bounds=Bounds(low, high),
            method="L-BFGS-B",
            options={"maxiter": STEPS},
        )

    tried = side_by_side(searched, STARTS, processes)
    best = np.exp(min(tried, key=lambda one: float(one.fun)).x)
    return Kernel(float(best[0]), best[1:-1]), float(best[-1])


def _misfit(samples: Samples, logs: Array) -> tuple[float, Array]:
    """Negative log marginal likelihood up to a constant, and its slope."""
    kernel = Kernel(float(np.exp(logs[0])), np.exp(logs[1:-1]))
    function = kernel.between(samples.inputs, samples.inputs)
    slow = np.exp(2 * logs[-1]) * samples.wander
    whole = function + slow + samples.noise
    whole[np.diag_indices_from(whole)] += JITTER * kernel.amplitude**2
    root = cho_factor(whole, lower=True)
    weights = cho_solve(root, samples.outcome)
    misfit = 0.5 * samples.outcome @ weights + np.log(np.diag(root[0])).sum()
    slack = cho_solve(root, np.eye(weights.size)) - np.outer(weights, weights)
    shared = slack * function
    scaled = samples.inputs / kernel.lengths
    # Sum of shared times squared distance, without a matrix of distances for each.
    apart = scaled**2 * shared.sum(1)[:, None] - scaled * (shared @ scaled)
    slope = [shared.sum(), *apart.sum(0), float((slack * slow).sum())]
    return float(misfit), np.array(slope)


@dataclass(frozen=True, slots=True)
class Process:
    """A function as the data leave it: mean and doubt anywhere."""

    kernel: Kernel
    centres: Array
    """Where the function is represented, shape ``(m, k)``."""
    weights: Array
    """Of the centres, shape ``(m,)``."""
    before: Array
    """Lower root of the covariance of the centres without data, shape ``(m, m)``."""
    after: Array
    """Lower root of its information with the data, shape ``(m, m)``."""

    @classmethod
    def given(
        cls, kernel: Kernel, centres: Array, features: Array, outcome: Array
    ) -> "Process":
        """Condition on data.

        Parameters
        ----------
        kernel
            Of the function.
        centres
            Where it is represented, shape ``(m, k)``.
        features
            ``kernel.between(inputs, centres)``, whitened, shape ``(n, m)``.
        outcome
            Whitened alike, shape ``(n,)``.
        """
        prior = kernel.between(centres, centres)
        prior[np.diag_indices_from(prior)] += JITTER * kernel.amplitude**2
        before = cholesky(prior, lower=True)
        # Their plain sum is indefinite by rounding where data tell far more than this.
        told = solve_triangular(before, features.T, lower=True)
        after = before @ cholesky(np.eye(len(told)) + told @ told.T, lower=True)
        weights = cho_solve((after, True), features.T @ outcome)
        return cls(kernel, centres, weights, before, after)

    def mean(self, inputs: Array) -> Array:
        """Expected value, shape ``(n,)``."""
        return self.kernel.between(inputs, self.centres) @ self.weights

    def doubt(self, inputs: Array) -> Array:
        """Posterior over prior variance, shape ``(n,)``. [0..1]."""
        near = self.kernel.between(inputs, self.centres).T
        known, open_ = (
            np.square(solve_triangular(root, near, lower=True)).sum(0)
            for root in (self.before, self.after)
        )
        return np.asarray(1 - (known - open_) / self.kernel.amplitude**2)
