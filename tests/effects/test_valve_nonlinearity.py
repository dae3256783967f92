"""The regulator's curve between the ends of its line."""

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from gripperd.effects.valve_nonlinearity import ValveNonlinearity

SPAN = (100e3, 500e3)


def deviation(effect: ValveNonlinearity, pressure: float) -> float:
    return float(effect.settled(pressure, SPAN)) - pressure


@pytest.mark.parametrize("pressure", [0.0, 100e3, 500e3, 600e3])
def test_the_line_holds_at_its_ends_and_beyond(pressure: float) -> None:
    bent = ValveNonlinearity(bow=5e3, skew=3e3)
    assert deviation(bent, pressure) == pytest.approx(0.0, abs=1e-9)


def test_the_bow_is_the_deviation_in_the_middle() -> None:
    bowed = ValveNonlinearity(bow=5e3)
    assert deviation(bowed, 300e3) == pytest.approx(5e3)
    assert deviation(bowed, 200e3) == pytest.approx(3750.0)


def test_the_skew_is_the_largest_deviation_and_changes_sign_in_the_middle() -> None:
    skewed = ValveNonlinearity(skew=5e3)
    peak = minimize_scalar(
        lambda p: -deviation(skewed, p), bounds=(100e3, 300e3), method="bounded"
    )
    assert -peak.fun == pytest.approx(5e3, rel=1e-6)
    assert deviation(skewed, 300e3) == pytest.approx(0.0, abs=1e-9)
    assert deviation(skewed, 450e3) == pytest.approx(-deviation(skewed, 150e3))


def test_bow_and_skew_hold_every_cubic_that_meets_the_ends() -> None:
    place = np.linspace(0.0, 1.0, 51)
    line = SPAN[0] + place * (SPAN[1] - SPAN[0])
    shapes = [
        np.asarray(effect.settled(line, SPAN)) - line
        for effect in (ValveNonlinearity(bow=1e3), ValveNonlinearity(skew=1e3))
    ]
    # Of another author: sagging most at a third of the line.
    wanted = place * (1 - place) ** 2
    weights = np.linalg.lstsq(np.transpose(shapes), wanted, rcond=None)[0]
    assert weights @ shapes == pytest.approx(wanted, abs=1e-12)
