"""Rubber that departs from eq. (5)."""

import numpy as np
import pytest

from gripperd.effects.nonlinear_elasticity import NonlinearElasticity
from gripperd.effects.rubber_elasticity import RubberElasticity
from gripperd.model import Muscle, StaticMuscle
from gripperd.model.track import Array

ALL = NonlinearElasticity(saturation=40.0, quadratic=-7.0, cubic=3.0, contraction=0.02)


def force(
    muscle: Muscle, effect: NonlinearElasticity, contraction: float, pressure: float = 0
) -> float:
    ideal = StaticMuscle(muscle).force(pressure, contraction)
    return float(StaticMuscle(muscle, (effect,)).force(pressure, contraction) - ideal)


def test_it_vanishes_at_rest_length(muscle: Muscle) -> None:
    assert force(muscle, ALL, 0.0) == 0.0


@pytest.mark.parametrize("contraction", [-0.03, 0.05, 0.2])
def test_it_is_the_same_at_all_pressures(muscle: Muscle, contraction: float) -> None:
    vented = force(muscle, ALL, contraction)
    assert vented != 0
    assert force(muscle, ALL, contraction, 5e5) == pytest.approx(vented)


@pytest.mark.parametrize(
    "effect",
    [
        NonlinearElasticity(40.0),
        NonlinearElasticity(0, 7.0),
        NonlinearElasticity(0, 0, 3),
    ],
)
def test_it_pulls_back_to_rest_length_from_both_sides(
    muscle: Muscle, effect: NonlinearElasticity
) -> None:
    assert force(muscle, effect, 0.03) < 0
    assert force(muscle, effect, -0.03) == -force(muscle, effect, 0.03)


def test_saturation_is_reached_early_and_stays(muscle: Muscle) -> None:
    early = NonlinearElasticity(saturation=40.0, contraction=0.02)
    assert force(muscle, early, 0.02) == pytest.approx(-40 * (1 - 0.36787944))
    assert force(muscle, early, 0.25) == pytest.approx(-40.0, abs=2e-4)


def test_powers_have_their_size_at_a_tenth(muscle: Muscle) -> None:
    square, cube = NonlinearElasticity(quadratic=7.0), NonlinearElasticity(cubic=3.0)
    at_tenth, at_fifth = (
        [force(muscle, effect, h) for effect in (square, cube)] for h in (0.1, 0.2)
    )
    assert at_tenth == pytest.approx([-7.0, -3.0])
    assert at_fifth == pytest.approx([-28.0, -24.0])


def test_with_eq_5_it_follows_a_rubber_tube_of_finite_strain(muscle: Muscle) -> None:
    """A neo-Hookean bladder of the same modulus at small strain, in shear E / 3."""
    h = np.linspace(-0.03, 0.25, 57)
    volume = np.pi * muscle.diameter * muscle.wall_thickness * muscle.rest_length
    half_shear = muscle.elastic_modulus / 3 / 2

    def energy(h: Array) -> Array:
        axial = 1 - h
        sine = np.sqrt(1 - (axial * np.cos(muscle.braid_angle)) ** 2)
        hoop = sine / np.sin(muscle.braid_angle)
        stretches: Array = axial**2 + hoop**2 + (axial * hoop) ** -2
        return half_shear * volume * stretches

    pull = -(energy(h + 1e-6) - energy(h - 1e-6)) / (2e-6 * muscle.rest_length)
    models = [
        StaticMuscle(muscle, (RubberElasticity(),)),
        StaticMuscle(muscle, (NonlinearElasticity(1.0, contraction=0.3),)),
        StaticMuscle(muscle, (NonlinearElasticity(quadratic=1.0),)),
        StaticMuscle(muscle, (NonlinearElasticity(cubic=1.0),)),
    ]
    columns = np.stack([np.asarray(model.force(0.0, h)) for model in models], axis=1)
    fitted, *_ = np.linalg.lstsq(columns, pull)
    assert np.abs(pull - columns @ fitted).max() < 0.02 * np.abs(pull).max()
