"""Ends that do not contract with the middle."""

from itertools import pairwise

import numpy as np
import pytest

from gripperd.effects.tapered_ends import TaperedEnds
from gripperd.model import Muscle, StaticMuscle
from gripperd.model.muscle import CATALOGUE_RANGE


def gained(
    muscle: Muscle, ends: TaperedEnds, pressure: float, contraction: float
) -> float:
    with_ends = StaticMuscle(muscle, (ends,)).force(pressure, contraction)
    return float(with_ends - StaticMuscle(muscle).force(pressure, contraction))


def test_the_muscle_pulls_as_one_that_is_shorter(muscle: Muscle) -> None:
    ends = StaticMuscle(muscle, (TaperedEnds(excess=0.25),))
    # Eq. (4) at 0.4 MPa and h = 0.1, from 525.573 N at 0.3 MPa; the end is at 0.08.
    assert StaticMuscle(muscle).force(4e5, 0.1) == pytest.approx(700.8, abs=0.1)
    assert ends.force(4e5, 0.08) == pytest.approx(700.8, abs=0.1)


@pytest.mark.parametrize("pressure", [0.0, 3e5])
def test_at_rest_length_it_does_nothing(muscle: Muscle, pressure: float) -> None:
    assert gained(muscle, TaperedEnds(0.2, 0.2, 0.1), pressure, 0.0) == 0.0


def test_the_deficit_is_proportional_to_pressure_and_grows_with_contraction(
    muscle: Muscle,
) -> None:
    ends = TaperedEnds(excess=0.1)
    lost = [-gained(muscle, ends, 3e5, h) for h in np.linspace(0, CATALOGUE_RANGE[1])]
    assert all(less < more for less, more in pairwise(lost))
    once, twice = (gained(muscle, ends, p, 0.15) for p in (2e5, 4e5))
    assert twice == pytest.approx(2 * once, rel=1e-12)


def test_what_belongs_to_a_vented_muscle_fades_with_pressure(muscle: Muscle) -> None:
    # 1/e at 200 kPa.
    faded = gained(muscle, TaperedEnds(excess_vented=0.1), 200e3, 0.15)
    as_much = gained(muscle, TaperedEnds(excess=0.036787944), 200e3, 0.15)
    assert faded == pytest.approx(as_much, rel=1e-6)


def test_what_grows_with_contraction_has_its_size_at_a_tenth(muscle: Muscle) -> None:
    grown = TaperedEnds(excess_contracted=0.05)
    for contraction, excess in ((0.1, 0.05), (0.2, 0.1)):
        as_much = gained(muscle, TaperedEnds(excess), 3e5, contraction)
        assert gained(muscle, grown, 3e5, contraction) == pytest.approx(as_much)


@pytest.mark.parametrize("ends", [TaperedEnds(0.1), TaperedEnds(0.1, 0.1)])
def test_its_pressure_is_found_again_from_the_pull(
    muscle: Muscle, ends: TaperedEnds
) -> None:
    static = StaticMuscle(muscle, (ends,))
    force = static.force(250e3, 0.12)
    assert static.pressure(force, 0.12) == pytest.approx(250e3, abs=1e-3)
