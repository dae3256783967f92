import math
from collections.abc import Callable
from pathlib import Path

import pytest

from gripperd.config import load_chain, load_model, reference_chain
from gripperd.effects.braid_friction import BraidFriction, Form
from gripperd.effects.rubber_elasticity import RubberElasticity
from gripperd.model import Chain, Linkage, Muscle, Regulator, StaticMuscle

Write = Callable[[str, str], Path]
Refusal = Callable[[Callable[[Path], object], Path], list[str]]

MUSCLE = """\
name: small
muscle:
  rest_length_mm: 120
  diameter_mm: 10
  braid_angle_deg: 30
  wall_thickness_mm: 1
  elastic_modulus_MPa: 2.5
  friction_coefficient: 0.01
"""
WHOLE = (
    MUSCLE
    + """\
valve: {current_mA: [4, 20], pressure_kPa: [5, 900]}
gripper: {open_width_mm: 60, width_per_contraction: 2.5, spring_preload_N: 30,
          spring_rate_N_per_mm: 0.5}
effects: [rubber_elasticity, {name: braid_friction, form: as_printed}]
"""
)


def test_a_model_file_becomes_a_chain_in_si(write: Write) -> None:
    assert load_chain(write("small.yaml", WHOLE)) == Chain(
        name="small",
        static=StaticMuscle(
            Muscle(
                rest_length=0.12,
                diameter=0.01,
                braid_angle=math.pi / 6,
                wall_thickness=0.001,
                elastic_modulus=2.5e6,
                friction_coefficient=0.01,
            ),
            (RubberElasticity(), BraidFriction(form=Form.AS_PRINTED)),
        ),
        regulator=Regulator(
            current_low=0.004,
            current_high=0.02,
            pressure_low=5e3,
            pressure_high=900e3,
        ),
        linkage=Linkage(
            open_width=0.06, ratio=2.5, spring_preload=30.0, spring_rate=500.0
        ),
    )


def test_the_shipped_reference_is_the_muscle_of_the_paper() -> None:
    chain = reference_chain()
    assert chain.muscle == Muscle(
        rest_length=0.25,
        diameter=0.02,
        braid_angle=math.radians(25),
        wall_thickness=0.002,
        elastic_modulus=1.3e6,
        friction_coefficient=0.002,
    )
    assert chain.static.effects == (RubberElasticity(), BraidFriction())
    assert chain.regulator.pressure(0.020) == 500e3
    # Half of the stroke of a quarter: 85 mm - 4.0 * 250 mm * 0.05.
    assert chain.linkage.opening(0.05, 0.25) == pytest.approx(0.035)
    assert chain.linkage.spring_force(0.1, 0.25) == pytest.approx(240 + 25)


def test_the_tolerances_of_the_reference_are_in_si_under_the_paths_of_the_chain() -> (
    None
):
    assert reference_chain().tolerances == pytest.approx(
        {
            "muscle.rest_length": 0.5e-3,
            "muscle.diameter": 0.1e-3,
            "muscle.braid_angle": 0.1 * math.pi / 180,
            "muscle.wall_thickness": 0.05e-3,
            "muscle.elastic_modulus": 0.04e6,
            "muscle.friction_coefficient": 0.0005,
            "valve.pressure_high": 5e3,
            "gripper.open_width": 0.2e-3,
            "gripper.ratio": 0.02,
            "gripper.spring_preload": 4.8,
            "gripper.spring_rate": 20.0,
        },
        rel=1e-12,
    )


def test_every_tolerance_of_the_reference_moves_the_chain() -> None:
    chain = reference_chain()
    for path, sigma in chain.tolerances.items():
        assert chain.varied(path, sigma) != chain


def test_a_muscle_alone_is_a_model_but_no_chain(write: Write, refusal: Refusal) -> None:
    path = write("bare.yaml", MUSCLE)
    model = load_model(path)
    assert (model.regulator, model.linkage) == (None, None)
    assert model.static.muscle.diameter == 0.01
    assert model.static.effects == ()
    assert refusal(load_chain, path) == [
        "bare.yaml: valve: is missing; without it a current gives no grip force",
        "bare.yaml: gripper: is missing; without it a current gives no grip force",
    ]


def test_a_model_file_may_lack_its_gripper_only(write: Write, refusal: Refusal) -> None:
    text = MUSCLE + "valve: {current_mA: [4, 20], pressure_kPa: [0, 600]}\n"
    path = write("bare.yaml", text)
    assert load_model(path).regulator == Regulator(
        current_low=0.004, current_high=0.02, pressure_low=0.0, pressure_high=600e3
    )
    assert refusal(load_chain, path) == [
        "bare.yaml: gripper: is missing; without it a current gives no grip force"
    ]


@pytest.mark.parametrize(
    ("good", "bad", "complaint"),
    [
        (
            "angle_deg: 30",
            "angle_deg: 60",
            "muscle.braid_angle_deg: 60 deg is above 54 deg",
        ),
        (
            "angle_deg: 30",
            "angle_deg: 4",
            "muscle.braid_angle_deg: 4 deg is below 5 deg",
        ),
        (
            "diameter_mm: 10",
            "diameter_mm: 0.5",
            "muscle.diameter_mm: 0.5 mm is below 1 mm",
        ),
        (
            "wall_thickness_mm: 1",
            "wall_thickness_mm: 5",
            "muscle.wall_thickness_mm: two walls of 5 mm leave no bore in 10 mm",
        ),
        (
            "MPa: 2.5",
            "MPa: 2500",
            "muscle.elastic_modulus_MPa: 2500 MPa is above 1000 MPa",
        ),
        (
            "coefficient: 0.01",
            "coefficient: -0.01",
            "muscle.friction_coefficient: -0.01 is below 0",
        ),
        (
            "[4, 20]",
            "[20, 4]",
            "valve.current_mA: the low end, 20 mA, is not below the high end, 4 mA",
        ),
        (
            "[4, 20]",
            "[0.004, 0.02]",
            "valve.current_mA: from 0.004 to 0.02 mA it is less than 1 mA, which no"
            " output could divide; is it in A?",
        ),
        (
            "[5, 900]",
            "[5, 5]",
            "valve.pressure_kPa: the low end, 5 kPa, is not below the high end, 5 kPa",
        ),
        ("[5, 900]", "[5]", "valve.pressure_kPa[1]: is missing (kPa)"),
        (
            "[5, 900]",
            "[5, 9, 900]",
            "valve.pressure_kPa: a list of 3 is not a pair [low, high]",
        ),
        (
            "[5, 900]",
            "[5, 9e6]",
            "valve.pressure_kPa[1]: 9000000 kPa is above 2000 kPa",
        ),
        (
            "open_width_mm",
            "open_width_cm",
            'gripper.open_width_cm: is not a key here; did you mean "open_width_mm"?',
        ),
        (
            "name: small",
            "name: ../small",
            'name: "../small" is not a name: 1 to 64 of a-z A-Z 0-9 _ . - that start'
            " with a letter or digit",
        ),
    ],
)
def test_what_cannot_be_built_is_refused_with_its_limit(
    write: Write, refusal: Refusal, good: str, bad: str, complaint: str
) -> None:
    assert WHOLE.count(good) == 1
    path = write("small.yaml", WHOLE.replace(good, bad))
    said = [line.partition(": ")[2] for line in refusal(load_chain, path)]
    assert complaint in said
    expected = WHOLE[: WHOLE.index(good)].count("\n") + 1
    assert f"small.yaml:{expected}: {complaint}" in refusal(load_chain, path)
