"""Roots of many functions at once."""

import math

import numpy as np
import pytest

from gripperd.model.root import falling_root, falling_roots


def test_every_function_gets_its_own_root() -> None:
    level = np.array([[0.0, 1e-9, 0.5], [1.0, 30.0, 64.0]])
    low, high = np.zeros((2, 3)), np.full((2, 3), 4.0)
    found = falling_roots(lambda x: level - x**3, low, high)
    assert found == pytest.approx(np.cbrt(level), abs=1e-12)


def test_a_step_is_found_like_a_slope() -> None:
    edges = np.array([-0.7, 0.0, 0.3])
    found = falling_roots(lambda x: np.sign(edges - x), -np.ones(3), np.ones(3))
    assert found == pytest.approx(edges, abs=1e-12)


def test_one_and_many_find_the_number_that_is_its_own_cosine() -> None:
    expected = 0.7390851332151607
    one = falling_root(lambda x: math.cos(x) - x, 0.0, 1.0)
    assert one == pytest.approx(expected, abs=1e-12)
    many = falling_roots(lambda x: np.cos(x) - x, np.zeros(2), np.ones(2))
    assert many == pytest.approx(expected, abs=1e-12)


def test_what_is_not_a_number_has_no_root() -> None:
    level = np.array([np.nan, 0.25])
    found = falling_roots(lambda x: level - x, np.zeros(2), np.ones(2))
    assert np.isnan(found[0])
    assert found[1] == pytest.approx(0.25)
