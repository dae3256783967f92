"""Pressure that is spent before the braid carries."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gripperd.effects.threshold_pressure import ThresholdPressure
from gripperd.model import Muscle, StaticMuscle

CONTRACTIONS = st.floats(-0.03, 0.3)


@given(above=st.floats(0, 700e3), contraction=CONTRACTIONS)
def test_above_it_the_muscle_pulls_as_with_that_much_less_pressure(
    muscle: Muscle, above: float, contraction: float
) -> None:
    late = StaticMuscle(muscle, (ThresholdPressure(60e3),))
    expected = StaticMuscle(muscle).force(above, contraction)
    assert late.force(60e3 + above, contraction) == pytest.approx(expected, abs=1e-9)


@given(pressure=st.floats(-60e3, 60e3), contraction=CONTRACTIONS)
def test_below_it_the_muscle_does_not_pull(
    muscle: Muscle, pressure: float, contraction: float
) -> None:
    late = StaticMuscle(muscle, (ThresholdPressure(60e3),))
    assert late.force(pressure, contraction) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("pressure", [0.0, 20e3, 80e3, 100e3, 130e3, 500e3])
def test_softened_it_leaves_a_softplus_of_the_pressure(
    muscle: Muscle, pressure: float
) -> None:
    soft = StaticMuscle(muscle, (ThresholdPressure(100e3, 10e3),))
    left = float(soft.force(pressure, 0.0) / muscle.pull_area(0.0))
    softplus = 10e3 * math.log1p(math.exp((pressure - 100e3) / 10e3))
    assert left == pytest.approx(softplus, abs=0.5)


@pytest.mark.parametrize("softness", [0.0, 10e3, 100e3])
def test_a_vented_muscle_has_no_pull(muscle: Muscle, softness: float) -> None:
    soft = StaticMuscle(muscle, (ThresholdPressure(60e3, softness),))
    assert soft.force(0.0, 0.1) == 0.0


@pytest.mark.parametrize("softness", [0.0, 1e3, 40e3])
def test_far_above_it_its_softness_makes_no_difference(
    muscle: Muscle, softness: float
) -> None:
    soft = StaticMuscle(muscle, (ThresholdPressure(60e3, softness),))
    expected = StaticMuscle(muscle).force(940e3, 0.1)
    assert soft.force(1e6, 0.1) == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("softness", [0.0, 15e3])
@pytest.mark.parametrize("contraction", [0.0, 0.1])
def test_its_pressure_is_found_again_from_the_pull(
    muscle: Muscle, softness: float, contraction: float
) -> None:
    late = StaticMuscle(muscle, (ThresholdPressure(60e3, softness),))
    pressure = np.linspace(90e3, 500e3, 5)
    force = late.force(pressure, contraction)
    assert late.pressure(force, contraction) == pytest.approx(pressure, abs=1e-3)


def test_a_reading_that_is_missing_stays_so_in_silence(muscle: Muscle) -> None:
    late = StaticMuscle(muscle, (ThresholdPressure(60e3, 15e3),))
    force = late.force(np.array([np.nan, 300e3]), 0.1)
    assert np.isnan(force).tolist() == [True, False]
