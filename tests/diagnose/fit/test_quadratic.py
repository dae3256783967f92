"""Against the definition of a quadratic, and another solver of the same."""

import numpy as np
import pytest
from scipy.optimize import Bounds, minimize

from gripperd.diagnose.fit.quadratic import Quadratic
from gripperd.model.track import Array

HERE = np.array([0.3, -0.2, 0.1])
MATRIX = np.array([[4.0, 1.0, 0.0], [1.0, 3.0, -1.0], [0.0, -1.0, 2.0]])
PULL = np.array([2.0, -5.0, 1.0])
FAR = np.full(3, 10.0)
NEAR = np.array([0.5, 1.0, 0.05])


def _cost(vector: Array, damping: float = 0.0) -> float:
    """Less that at the point, from gradient and Hessian."""
    way = vector - HERE
    hessian = 2 * (MATRIX + damping * np.diag([4.0, 3.0, 2.0]))
    return float(-2 * PULL @ way + 0.5 * way @ hessian @ way)


@pytest.mark.parametrize("reach", [FAR, NEAR])
@pytest.mark.parametrize("damping", [0.0, 0.5, 100.0])
def test_the_lowest_place_is_that_of_another_optimiser(
    damping: float, reach: Array
) -> None:
    found = Quadratic(HERE, MATRIX, PULL).lowest(damping, -reach, reach)
    start = np.clip(HERE, -reach, reach)
    best = minimize(
        _cost, start, (damping,), method="L-BFGS-B", bounds=Bounds(-reach, reach)
    )
    assert found == pytest.approx(best.x, abs=1e-5)


def test_the_fall_is_that_of_the_cost() -> None:
    aim = np.array([1.0, -2.0, 0.4])
    assert Quadratic(HERE, MATRIX, PULL).fall(aim) == pytest.approx(-_cost(aim))
