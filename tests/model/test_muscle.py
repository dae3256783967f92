"""Geometry of the braid against first principles and published numbers."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import brentq

from gripperd.model import Muscle

CONTRACTIONS = st.floats(-0.03, 0.36)

MUSCLES = st.builds(
    Muscle,
    rest_length=st.floats(0.05, 1.0),
    diameter=st.floats(0.005, 0.05),
    braid_angle=st.floats(math.radians(18), math.radians(35)),
    wall_thickness=st.floats(0.5e-3, 3e-3),
    elastic_modulus=st.floats(0.5e6, 5e6),
    friction_coefficient=st.floats(0.0, 0.1),
)


def braid_volume(muscle: Muscle, contraction: float) -> float:
    """Volume of the cylinder that one strand of constant length winds around."""
    strand = muscle.rest_length / math.cos(muscle.braid_angle)
    turns = strand * math.sin(muscle.braid_angle) / (math.pi * muscle.diameter)
    angle = math.acos((1 - contraction) * math.cos(muscle.braid_angle))
    length, diameter = (
        strand * math.cos(angle),
        strand * math.sin(angle) / (math.pi * turns),
    )
    return math.pi * diameter**2 / 4 * length


@given(muscle=MUSCLES, contraction=st.floats(-0.03, 0.36))
def test_the_volume_is_that_of_a_strand_of_constant_length(
    muscle: Muscle, contraction: float
) -> None:
    expected = braid_volume(muscle, contraction)
    assert muscle.volume(contraction) == pytest.approx(expected, rel=1e-12)


@given(muscle=MUSCLES, contraction=CONTRACTIONS)
def test_the_ideal_pull_is_the_volume_gained_per_length_lost(
    muscle: Muscle, contraction: float
) -> None:
    step = 1e-5
    gained = braid_volume(muscle, contraction + step) - braid_volume(
        muscle, contraction - step
    )
    lost = 2 * step * muscle.rest_length
    at_rest = muscle.pull_area(0.0)
    assert muscle.pull_area(contraction) == pytest.approx(
        gained / lost, abs=1e-8 * float(at_rest)
    )


@given(muscle=MUSCLES)
def test_the_pull_is_spent_at_the_magic_angle(muscle: Muscle) -> None:
    spent = brentq(lambda h: float(muscle.pull_area(h)), 0.0, 0.5, xtol=1e-14)
    assert muscle.spent == pytest.approx(spent, abs=1e-12)
    angle = math.acos((1 - muscle.spent) * math.cos(muscle.braid_angle))
    assert math.degrees(angle) == pytest.approx(54.7356, abs=1e-4)


def test_the_papers_muscle_is_spent_at_36_percent(muscle: Muscle) -> None:
    assert muscle.spent == pytest.approx(0.36296, abs=5e-6)


def test_the_papers_muscle_is_straight_at_10_percent_stretch(muscle: Muscle) -> None:
    assert muscle.straight == pytest.approx(-0.1034, abs=5e-5)
    assert muscle.diameter_ratio(muscle.straight) == pytest.approx(0, abs=1e-7)


@given(muscle=MUSCLES)
def test_the_diameter_at_rest_is_exactly_the_diameter_at_rest(muscle: Muscle) -> None:
    assert muscle.diameter_ratio(0.0) == 1.0


def test_the_papers_muscle_pulls_2575_square_millimetres_times_pressure(
    muscle: Muscle,
) -> None:
    assert muscle.pull_area(0.0) == pytest.approx(2.57542e-3, rel=2e-6)


def test_the_stiffness_at_rest_is_the_slope_of_the_elastic_force(
    muscle: Muscle,
) -> None:
    near, far = 1e-6, 2e-6
    here, there = (
        muscle.elastic_force(h, muscle.diameter_ratio(h)) for h in (near, far)
    )
    slope = (there - here) / (far - near)
    assert muscle.elastic_stiffness == pytest.approx(slope, rel=1e-4)
