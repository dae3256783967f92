import numpy as np
import pytest
from scipy.optimize import lsq_linear
from scipy.stats import multivariate_normal

from gripperd.diagnose.fit.gram import Gram, bounded
from gripperd.model.track import Array

RUNS, SAMPLES, COLUMNS = 4, 30, 5
FREE = np.full(COLUMNS, np.inf)


def _random(seed: int = 0) -> tuple[Array, Array]:
    """Whitened columns (runs, n, m) and residuals (runs, n)."""
    random = np.random.default_rng(seed)
    columns = random.normal(size=(RUNS, SAMPLES, COLUMNS))
    columns[..., 1] = 0.8 * columns[..., 0] + 0.4 * columns[..., 1]
    target = columns @ random.normal(0.0, 2.0, COLUMNS)
    return columns, target + random.normal(size=(RUNS, SAMPLES))


def _gram(
    columns: Array, target: Array, low: Array = -FREE, high: Array = FREE
) -> Gram:
    return Gram(
        np.einsum("rni,rnj->ij", columns, columns),
        np.einsum("rni,rn->i", columns, target),
        float(np.sum(target**2)),
        low,
        high,
    )


def _stacked(columns: Array, target: Array) -> tuple[Array, Array]:
    """The same least squares, the unit priors as further rows."""
    z = columns.reshape(-1, columns.shape[-1])
    rows = np.vstack([z, np.eye(z.shape[1])])
    return rows, np.concatenate([target.ravel(), np.zeros(z.shape[1])])


@pytest.mark.parametrize("seed", range(12))
def test_a_fit_within_bounds_is_the_least_squares_within_bounds(seed: int) -> None:
    columns, target = _random(seed)
    low = np.array([0.0, -np.inf, 0.0, -0.5, -0.5])
    high = np.array([np.inf, np.inf, np.inf, 0.5, 0.5])
    fit = _gram(columns, target, low, high).fit(range(COLUMNS))
    best = lsq_linear(*_stacked(columns, target), (low, high), tol=1e-12)
    np.testing.assert_allclose(fit.coefficients, best.x, atol=1e-6)
    assert fit.cost == pytest.approx(2 * best.cost)


def test_a_bound_is_left_again_when_the_rest_has_moved() -> None:
    matrix = np.array([[15.0, -10.0, -11.0], [-10.0, 11.0, 5.0], [-11.0, 5.0, 15.0]])
    moments = np.array([4.0, -8.0, -7.0])
    best = bounded(matrix, moments, np.zeros(3), np.full(3, np.inf))
    # By hand: with the others at 0 the first is 4/15, and neither other one gains.
    np.testing.assert_allclose(best, [4 / 15, 0.0, 0.0], atol=1e-9)


def test_the_evidence_is_the_marginal_likelihood() -> None:
    columns, target = _random()
    chosen = [0, 2, 3]
    fit = _gram(columns, target).fit(chosen)
    z, y = columns.reshape(-1, COLUMNS)[:, chosen], target.ravel()
    law = multivariate_normal(np.zeros(y.size), np.eye(y.size) + z @ z.T)
    shared = -0.5 * y.size * np.log(2 * np.pi)
    assert fit.evidence + shared == pytest.approx(float(law.logpdf(y)))


def test_no_column_explains_nothing() -> None:
    columns, target = _random()
    fit = _gram(columns, target).fit([])
    assert fit.cost == pytest.approx(float(np.sum(target**2)))


def test_the_best_is_the_same_wherever_the_solution_starts() -> None:
    columns, target = _random()
    z = columns.reshape(-1, COLUMNS)
    matrix, moments = z.T @ z + np.eye(COLUMNS), z.T @ target.ravel()
    low, high = np.array([-1.0, 0.0, 0.0, -0.1, 0.3]), np.full(COLUMNS, 0.5)
    best = bounded(matrix, moments, low, high)
    for start in (low, high, (low + high) / 2):
        np.testing.assert_allclose(
            bounded(matrix, moments, low, high, start), best, atol=1e-9
        )


def test_what_is_held_from_both_sides_stays() -> None:
    held = np.array([2.0, -3.0])
    matrix = np.array([[2.0, 1.0, 0.0], [1.0, 3.0, 1.0], [0.0, 1.0, 4.0]])
    low, high = np.array([2.0, -3.0, -9.0]), np.array([2.0, -3.0, 9.0])
    best = bounded(matrix, np.array([1.0, 1.0, 1.0]), low, high)
    np.testing.assert_allclose(best, [*held, (1.0 + 3.0) / 4.0])
