"""Eq. (6), rebraced and as printed."""

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gripperd.effects.braid_friction import BraidFriction, Form
from gripperd.model import Direction, Muscle, MuscleState

PRESSURES = st.floats(0, 800e3)
CONTRACTIONS = st.floats(-0.03, 0.36)


def state(muscle: Muscle, pressure: float, contraction: float) -> MuscleState:
    ratio = muscle.diameter_ratio(contraction)
    return MuscleState(pressure, contraction, ratio, Direction.CONTRACTING)


def magnitude(
    muscle: Muscle, pressure: float, contraction: float, form: Form = Form.REBRACED
) -> float:
    at = state(muscle, pressure, contraction)
    return float(BraidFriction(form).magnitude(at, muscle))


def in_millimetres(muscle: Muscle) -> Muscle:
    """The same muscle in mm and MPa, so that a force is still in N."""
    return replace(
        muscle,
        rest_length=1e3 * muscle.rest_length,
        diameter=1e3 * muscle.diameter,
        wall_thickness=1e3 * muscle.wall_thickness,
        elastic_modulus=1e-6 * muscle.elastic_modulus,
    )


@given(pressure=PRESSURES, contraction=CONTRACTIONS)
def test_it_is_contact_pressure_times_area_times_coefficient(
    muscle: Muscle, pressure: float, contraction: float
) -> None:
    angle = math.acos((1 - contraction) * math.cos(muscle.braid_angle))
    radius = muscle.diameter / 2 * math.sin(angle) / math.sin(muscle.braid_angle)
    # A thin ring of rubber stretched to this radius carries a pressure of its own.
    strain = 2 * radius / muscle.diameter - 1
    carried = muscle.elastic_modulus * strain * muscle.wall_thickness / radius
    area = 2 * math.pi * radius * muscle.rest_length * (1 - contraction)
    pressed = max(pressure - carried, 0.0)
    expected = muscle.friction_coefficient * pressed * area
    assert magnitude(muscle, pressure, contraction) == pytest.approx(expected, abs=1e-9)


@given(pressure=PRESSURES, contraction=CONTRACTIONS)
def test_rebraced_it_is_the_same_in_every_unit_system(
    muscle: Muscle, pressure: float, contraction: float
) -> None:
    other = magnitude(in_millimetres(muscle), 1e-6 * pressure, contraction)
    assert magnitude(muscle, pressure, contraction) == pytest.approx(other, abs=1e-9)


def test_as_printed_it_depends_on_the_unit_system(muscle: Muscle) -> None:
    si = magnitude(muscle, 0.4e6, 0.1, Form.AS_PRINTED)
    other = magnitude(in_millimetres(muscle), 0.4, 0.1, Form.AS_PRINTED)
    assert si == pytest.approx(15.82, abs=0.005)
    assert other == pytest.approx(5.43, abs=0.005)


def test_as_printed_a_vented_muscle_at_rest_has_friction(muscle: Muscle) -> None:
    assert magnitude(muscle, 0.0, 0.0, Form.AS_PRINTED) == pytest.approx(2.23, abs=5e-3)
    assert magnitude(muscle, 0.0, 0.0) == 0.0


@pytest.mark.parametrize(
    ("contraction", "kilopascal"),
    [(0.05, 44), (0.10, 70), (0.15, 88), (0.20, 100), (0.25, 110)],
)
def test_below_its_threshold_pressure_the_bladder_does_not_touch_the_braid(
    muscle: Muscle, contraction: float, kilopascal: float
) -> None:
    ratio = muscle.diameter_ratio(contraction)
    (kink,) = BraidFriction().kinks(contraction, ratio, muscle)
    assert kink == pytest.approx(1e3 * kilopascal, abs=500)
    assert magnitude(muscle, 0.999 * float(kink), contraction) == 0.0
    assert magnitude(muscle, 1.001 * float(kink), contraction) > 0.0


@given(pressure=PRESSURES, contraction=CONTRACTIONS, form=st.sampled_from(Form))
def test_it_opposes_the_travel(
    muscle: Muscle, pressure: float, contraction: float, form: Form
) -> None:
    friction = BraidFriction(form)
    contracting = state(muscle, pressure, contraction)
    extending = contracting._replace(direction=Direction.EXTENDING)
    size = magnitude(muscle, pressure, contraction, form)
    assert friction.force(contracting, muscle) == -size
    assert friction.force(extending, muscle) == size


@given(share=st.floats(0, 10), form=st.sampled_from(Form))
def test_a_share_of_it_is_as_a_coefficient_larger_by_that(
    muscle: Muscle, share: float, form: Form
) -> None:
    rough = replace(muscle, friction_coefficient=share * muscle.friction_coefficient)
    at = state(muscle, 300e3, 0.1)
    expected = BraidFriction(form).force(at, rough)
    found = BraidFriction(form, share=share).force(at, muscle)
    assert found == pytest.approx(expected, rel=1e-12)


@given(pressure=PRESSURES, contraction=CONTRACTIONS)
def test_rebraced_it_never_drives(
    muscle: Muscle, pressure: float, contraction: float
) -> None:
    assert magnitude(muscle, pressure, contraction) >= 0
