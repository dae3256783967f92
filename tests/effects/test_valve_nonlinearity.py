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


@pytest.mark.parametrize(
    ("effect", "least", "most"),
    [
        (ValveNonlinearity(wave=6e3), (300e3, -6e3), (136.7e3, 2e3)),
        (ValveNonlinearity(skew_wave=6e3), (223.1e3, -6e3), (376.9e3, 6e3)),
    ],
)
def test_a_wave_is_the_largest_deviation(
    effect: ValveNonlinearity, least: tuple[float, float], most: tuple[float, float]
) -> None:
    """Roots of the derivative of ``(1 - u²) P(u)``, u from -1 to 1.

    Of order 2 they are u = 0 and u² = 2/3; of order 3 u² = (12 - sqrt 69) / 25.
    """
    for place, size in (least, most):
        around = minimize_scalar(
            lambda p, size=size: -size * deviation(effect, p),
            bounds=(place - 20e3, place + 20e3),
            method="bounded",
        )
        assert around.x == pytest.approx(place, abs=200.0)
        assert deviation(effect, around.x) == pytest.approx(size, rel=1e-3)


def test_the_four_hold_every_quintic_that_meets_the_ends() -> None:
    place = np.linspace(0.0, 1.0, 51)
    line = SPAN[0] + place * (SPAN[1] - SPAN[0])
    shapes = [
        np.asarray(ValveNonlinearity(**{name: 1e3}).settled(line, SPAN)) - line
        for name in ("bow", "skew", "wave", "skew_wave")
    ]
    # Of another author: sagging most at a fifth of the line, then a bump beyond it.
    wanted = place * (1 - place) ** 4 - 0.3 * place**3 * (1 - place)
    weights = np.linalg.lstsq(np.transpose(shapes), wanted, rcond=None)[0]
    assert weights @ shapes == pytest.approx(wanted, abs=1e-12)
