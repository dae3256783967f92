"""A part that gives under its load."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from gripperd.model.spring import extension


def test_in_proportion_it_is_the_law_of_hooke() -> None:
    assert extension(300.0, 1e-5, 0.0) == pytest.approx(3e-3)


def test_its_stiffness_rises_in_proportion_to_the_load() -> None:
    compliance, stiffening = 2e-5, 0.03
    drawn = np.linspace(0.0, 1.5e-3, 6)
    told = solve_ivp(
        lambda _, load: (1 + stiffening * load) / compliance,
        (0.0, drawn[-1]),
        [0.0],
        t_eval=drawn,
        rtol=1e-10,
        atol=1e-9,
    )
    found = extension(told.y[0], compliance, stiffening)
    assert found == pytest.approx(drawn, rel=1e-7, abs=1e-12)


def test_one_that_hardly_stiffens_is_near_that_law() -> None:
    assert extension(100.0, 1e-5, 1e-9) == pytest.approx(1e-3, rel=1e-6)
