"""Springs that stick, then slip."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from gripperd.model.prandtl import at_rest, carried
from gripperd.model.track import Array

FORCES = (1.0, 2.0, 3.0)
ALONE = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
PATHS = arrays(np.float64, st.integers(1, 40), elements=st.floats(-5.0, 5.0))


def stretched(path: Array) -> float:
    """The same springs by their own law: each stretches, and slips at its force."""
    springs = [0.0, 0.0, 0.0]
    for step in np.diff(path):
        for index, (force, reach) in enumerate(zip(FORCES, (1 / 3, 1, 3), strict=True)):
            pulled = springs[index] + force / reach * step
            springs[index] = min(max(pulled, -force), force)
    return sum(springs)


@given(path=PATHS)
def test_it_is_springs_in_parallel_that_slip(path: Array) -> None:
    force = carried(path, 1.0, FORCES, at_rest())
    assert force[0] == 0
    assert force[-1] == pytest.approx(stretched(path), abs=1e-9)


@given(path=PATHS, cut=st.integers(0, 40))
def test_the_memory_carries_from_one_piece_to_the_next(path: Array, cut: int) -> None:
    memory = at_rest()
    pieces = [carried(part, 1.0, FORCES, memory) for part in (path[:cut], path[cut:])]
    whole = carried(path, 1.0, FORCES, at_rest())
    assert np.concatenate(pieces).tolist() == whole.tolist()


@pytest.mark.parametrize(
    "law",
    [lambda x: 1 - np.exp(-x), np.tanh, lambda x: x / (1 + x)],
    ids=["exponential", "hyperbolic tangent", "hyperbola"],
)
def test_three_springs_follow_the_laws_of_other_authors(law: np.ufunc) -> None:
    path = np.linspace(0.0, 10.0, 200)
    goal = law(path)
    left = []
    for radius in np.geomspace(0.3, 3.0, 12):
        springs = [carried(path, radius, one, at_rest()) for one in ALONE]
        columns = np.stack(springs, axis=1)
        fitted, *_ = np.linalg.lstsq(columns, goal)
        left.append(np.std(goal - columns @ fitted))
    assert min(left) < 0.02
