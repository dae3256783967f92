"""Strands that stretch with pressure."""

from math import cos, pi, sin

import numpy as np
import pytest

from gripperd.effects.braid_extensibility import BraidExtensibility
from gripperd.model import Muscle, StaticMuscle

PER_MEGAPASCAL = 1e-6


def pull_from_volume(
    muscle: Muscle, pressure: float, contraction: float, stretch: float
) -> float:
    """Virtual work of a braid with longer strands, by a difference: -p dV/dL. [N]."""
    strand = muscle.rest_length / cos(muscle.braid_angle)
    turns = strand * sin(muscle.braid_angle) / (pi * muscle.diameter)

    def volume(length: float) -> float:
        diameter_squared = ((strand * (1 + stretch)) ** 2 - length**2) / (
            pi * turns
        ) ** 2
        return pi / 4 * diameter_squared * length

    length, step = muscle.rest_length * (1 - contraction), 1e-6
    change = volume(length + step) - volume(length - step)
    return -pressure * change / (2 * step)


@pytest.mark.parametrize("contraction", [-0.03, 0.0, 0.1, 0.25])
@pytest.mark.parametrize("pressure", [1e5, 4e5, 8e5])
def test_it_is_the_virtual_work_of_longer_strands(
    muscle: Muscle, pressure: float, contraction: float
) -> None:
    braid = BraidExtensibility(strain=0.03 * PER_MEGAPASCAL)
    static = StaticMuscle(muscle, (braid,))
    expected = pull_from_volume(muscle, pressure, contraction, 0.03e-6 * pressure)
    assert static.force(pressure, contraction) == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("contraction", [0.0, 0.2])
def test_the_deficit_grows_with_the_square_of_pressure(
    muscle: Muscle, contraction: float
) -> None:
    braid = BraidExtensibility(strain=1e-4 * PER_MEGAPASCAL)
    pressure = np.array([1e5, 2e5, 3e5])
    ideal = StaticMuscle(muscle).force(pressure, contraction)
    stretched = StaticMuscle(muscle, (braid,)).force(pressure, contraction)
    lost = np.asarray(ideal - stretched)
    assert lost / lost[0] == pytest.approx([1, 4, 9], rel=1e-4)


def test_strands_that_carry_less_when_contracted_stretch_less(muscle: Muscle) -> None:
    braid = BraidExtensibility(0.02 * PER_MEGAPASCAL, -0.002 * PER_MEGAPASCAL)
    static = StaticMuscle(muscle, (braid,))
    # The length is 4/5 of that at rest, and so is the stretch.
    expected = pull_from_volume(muscle, 4e5, 0.2, 0.8 * 0.02e-6 * 4e5)
    assert static.force(4e5, 0.2) == pytest.approx(expected, rel=1e-6)


def test_its_pressure_is_found_again_from_the_pull(muscle: Muscle) -> None:
    static = StaticMuscle(muscle, (BraidExtensibility(0.02 * PER_MEGAPASCAL),))
    pressure = np.linspace(-50e3, 800e3, 7)
    force = static.force(pressure, 0.1)
    assert static.pressure(force, 0.1) == pytest.approx(pressure, abs=1e-3)
