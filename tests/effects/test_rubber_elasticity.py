"""Eq. (5) against the work of the stresses in the bladder."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from gripperd.effects.rubber_elasticity import RubberElasticity
from gripperd.model import Direction, Muscle, MuscleState


def elastic_force(muscle: Muscle, contraction: float) -> float:
    """F_s, positive when it opposes contraction."""
    ratio = muscle.diameter_ratio(contraction)
    at = MuscleState(3e5, contraction, ratio, Direction.CONTRACTING)
    return -float(RubberElasticity().force(at, muscle))


def length_and_diameter(muscle: Muscle, angle: float) -> tuple[float, float]:
    """Eqs. (1)-(3): a strand of constant length at a braid angle. [m]."""
    strand = muscle.rest_length / math.cos(muscle.braid_angle)
    turns = strand * math.sin(muscle.braid_angle) / (math.pi * muscle.diameter)
    return strand * math.cos(angle), strand * math.sin(angle) / (math.pi * turns)


def work_per_radian(angle: float, muscle: Muscle) -> float:
    """Work of the axial and the hoop stress in a thin wall, per change of angle."""
    length, diameter = length_and_diameter(muscle, angle)
    axial = muscle.elastic_modulus * (length / muscle.rest_length - 1)
    hoop = muscle.elastic_modulus * (diameter / muscle.diameter - 1)
    lengthening = -length * math.tan(angle)
    widening = math.pi * diameter / math.tan(angle)
    wall = muscle.wall_thickness
    return wall * (axial * math.pi * diameter * lengthening + hoop * length * widening)


def stored(muscle: Muscle, angle: float) -> float:
    """Strain energy of the bladder at a braid angle. [J]."""
    return float(
        quad(work_per_radian, muscle.braid_angle, angle, (muscle,), epsabs=1e-13)[0]
    )


@given(contraction=st.floats(-0.03, 0.3))
def test_the_force_is_the_slope_of_the_strain_energy(
    muscle: Muscle, contraction: float
) -> None:
    angle, step = math.acos((1 - contraction) * math.cos(muscle.braid_angle)), 1e-4
    rise = stored(muscle, angle + step) - stored(muscle, angle - step)
    longer, shorter = (
        length_and_diameter(muscle, angle + way * step)[0] for way in (-1, 1)
    )
    slope = rise / (longer - shorter)
    assert elastic_force(muscle, contraction) == pytest.approx(slope, abs=1e-3)


def test_an_unstrained_bladder_gives_exactly_no_force(muscle: Muscle) -> None:
    assert elastic_force(muscle, 0.0) == 0.0


def test_it_rises_all_the_way_to_where_the_muscle_is_spent(muscle: Muscle) -> None:
    forces = [elastic_force(muscle, h) for h in np.linspace(0, 0.36, 361)]
    assert np.all(np.diff(forces) > 0)


def test_a_stretched_bladder_pulls(muscle: Muscle) -> None:
    assert elastic_force(muscle, -0.03) == pytest.approx(-146.487801, abs=5e-7)


@pytest.mark.parametrize(
    ("contraction", "published"),
    [(0.01, 33.3), (0.02, 61.5), (0.05, 124.5), (0.10, 186.3), (0.25, 250.0)],
)
def test_it_gives_the_published_force(
    muscle: Muscle, contraction: float, published: float
) -> None:
    assert elastic_force(muscle, contraction) == pytest.approx(published, abs=0.05)


def test_it_starts_at_14_newton_a_millimetre(muscle: Muscle) -> None:
    slope = (elastic_force(muscle, 1e-6) - elastic_force(muscle, -1e-6)) / 2e-6
    assert slope == pytest.approx(3618, abs=0.5)


def test_it_does_not_depend_on_pressure_or_direction(muscle: Muscle) -> None:
    ratio = muscle.diameter_ratio(0.1)
    states = [MuscleState(p, 0.1, ratio, d) for p in (0.0, 1e5, 8e5) for d in Direction]
    assert len({RubberElasticity().force(at, muscle) for at in states}) == 1
    assert RubberElasticity().kinks(0.1, ratio, muscle) == ()


def test_a_measured_curve_stands_in_for_eq_5(muscle: Muscle) -> None:
    # Two fits of 20 mm muscles agree on about 300 N (1 - exp(-h / 0.033)).
    early = RubberElasticity(share=0.0, saturation=300.0, contraction=0.033)
    ratio = muscle.diameter_ratio(0.033)
    for contraction, pull in ((0.033, 189.636), (-0.033, -189.636)):
        at = MuscleState(3e5, contraction, ratio, Direction.CONTRACTING)
        assert -float(early.force(at, muscle)) == pytest.approx(pull, abs=1e-3)


def test_a_share_of_eq_5_and_a_curve_add_up(muscle: Muscle) -> None:
    at = MuscleState(3e5, 0.1, muscle.diameter_ratio(0.1), Direction.CONTRACTING)
    both = RubberElasticity(share=0.5, quadratic=10.0, cubic=5.0)
    assert -float(both.force(at, muscle)) == pytest.approx(186.3 / 2 + 15, abs=0.025)
