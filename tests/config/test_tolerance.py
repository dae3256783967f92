from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import ClassVar

import pytest

from gripperd.config import load_model
from gripperd.model.kinds import InMuscle
from gripperd.model.parameter import amplitude, shape

Write = Callable[[str, str], Path]
Refusal = Callable[[Callable[[Path], object], Path], list[str]]

MODEL = """\
name: small
muscle:
  rest_length_mm: 120
  diameter_mm: {diameter}
  braid_angle_deg: 30
  wall_thickness_mm: 1
  elastic_modulus_MPa: 2.5
  friction_coefficient: 0.01
valve: {{current_mA: [4, 20], pressure_kPa: {pressure}}}
effects: {effects}
"""


@dataclass(frozen=True)
class Creep(InMuscle):
    """An effect with numbers of its own; the file cannot know them beforehand."""

    name: ClassVar[str] = "creep"
    needs: ClassVar[frozenset[str]] = frozenset()
    shows: ClassVar[str] = ""
    confused_with: ClassVar[tuple[str, ...]] = ()
    remedy: ClassVar[str] = ""
    weight: int
    amplitude: float = amplitude(unit="N", scale=1.0, low=0.0, high=500.0)
    rate: float = shape(unit="ms", starts=(1.0,), low=0.0041, high=2.0)
    slope: float = shape(unit="N_per_mm", starts=(0.0,), low=-1e3, high=1e3)
    value: float = 0.0


load = partial(load_model, effects={"creep": Creep})


def text(
    *, diameter: str = "10", pressure: str = "[0, 600]", effects: str = "[]"
) -> str:
    return MODEL.format(diameter=diameter, pressure=pressure, effects=effects)


def test_any_number_may_carry_a_tolerance(write: Write) -> None:
    model = load(
        write(
            "m.yaml",
            text(
                diameter="{value: 10, tolerance: 0.2}",
                pressure="[{value: 2, tolerance: 1}, {value: 600, tolerance: 5}]",
                effects="[{name: creep, weight: 1,"
                " rate_ms: {value: 30, tolerance: 5}}]",
            ),
        )
    )
    assert model.static.muscle.diameter == 0.010
    assert model.regulator is not None
    assert model.regulator.pressure_low == 2e3
    assert model.static.effects == (Creep(1, rate=0.03),)
    assert model.tolerances == {
        "muscle.diameter": pytest.approx(0.2e-3),
        "valve.pressure_low": 1e3,
        "valve.pressure_high": 5e3,
        "effects.creep.rate": 5e-3,
    }


def test_a_number_may_be_exact(write: Write) -> None:
    given = "{value: 10, tolerance: 0}"
    model = load(write("m.yaml", text(diameter=given)))
    assert model.static.muscle.diameter == pytest.approx(0.01)
    assert model.tolerances == {"muscle.diameter": 0.0}


def test_a_file_without_tolerances_has_none(write: Write) -> None:
    assert load(write("m.yaml", text())).tolerances == {}


@pytest.mark.parametrize(
    ("given", "complaint"),
    [
        ("{value: 10, tolerance: -1}", "tolerance: -1 mm is below 0 mm"),
        ("{value: 10}", "tolerance: is missing (mm)"),
        ("{value: 10, tolerance: 1 %}", 'tolerance: "1 %" is not a number (mm)'),
        ("{value: '10', tolerance: 1}", 'value: "10" is not a number (mm); write 10'),
    ],
)
def test_a_tolerance_that_is_none_is_refused_once(
    write: Write, refusal: Refusal, given: str, complaint: str
) -> None:
    said = refusal(load, write("m.yaml", text(diameter=given)))
    assert said == [f"m.yaml:4: muscle.diameter_mm.{complaint}"]


def test_a_misspelt_tolerance_is_recognised(write: Write, refusal: Refusal) -> None:
    given = "{value: 10, tolerence: 1}"
    said = refusal(load, write("m.yaml", text(diameter=given)))
    assert said == [
        "m.yaml:4: muscle.diameter_mm.tolerance: is missing (mm)",
        "m.yaml:4: muscle.diameter_mm.tolerence: is not a key here;"
        ' did you mean "tolerance"?',
    ]


@pytest.mark.parametrize(
    ("tolerance", "complaint"),
    [
        (9.5, "minus its tolerance, 0.5 mm is below 1 mm"),
        (195, "plus its tolerance, 205 mm is above 200 mm"),
    ],
)
def test_one_sigma_must_stay_possible(
    write: Write, refusal: Refusal, tolerance: float, complaint: str
) -> None:
    given = f"{{value: 10, tolerance: {tolerance}}}"
    said = refusal(load, write("m.yaml", text(diameter=given)))
    assert f"m.yaml:4: muscle.diameter_mm: {complaint}" in said


def test_one_sigma_of_an_effect_must_stay_possible(
    write: Write, refusal: Refusal
) -> None:
    effects = "[{name: creep, weight: 1, amplitude_N: {value: 3, tolerance: 4}}]"
    said = refusal(load, write("m.yaml", text(effects=effects)))
    assert said == [
        "m.yaml:10: effects[0].amplitude_N: minus its tolerance, -1 N is outside 0 to"
        " 500 N, the physical bounds of creep"
    ]


def test_text_has_no_tolerance(write: Write, refusal: Refusal) -> None:
    wrong = text().replace("name: small", "name: {value: 3, tolerance: 1}")
    assert refusal(load, write("m.yaml", wrong)) == [
        "m.yaml:1: name: 3 is not text; put it in quotes"
    ]


@pytest.mark.parametrize(
    ("effects", "complaints"),
    [
        ("[crep]", ['effects[0]: "crep" is not an effect; did you mean "creep"?']),
        ("[7]", ["effects[0]: 7 is not an effect; there are: creep"]),
        ("[{}]", ["effects[0]: an empty value is not an effect; there are: creep"]),
        ("creep", ['effects: "creep" is not a list of effects']),
        ("[creep]", ["effects[0].weight: is missing"]),
        (
            "[{name: creep, weight: 1, ampitude_N: 3}]",
            [
                "effects[0].ampitude_N: is not a parameter of creep;"
                ' did you mean "amplitude_N"?'
            ],
        ),
        (
            "[{name: creep, weight: 1, amplitude_mm: 3}]",
            [
                "effects[0].amplitude_mm: is not the unit of amplitude of creep;"
                " write amplitude_N"
            ],
        ),
        (
            "[{name: creep, weight: 1, amplitude: 3}]",
            [
                "effects[0].amplitude: is not the unit of amplitude of creep;"
                " write amplitude_N"
            ],
        ),
        (
            "[{name: creep, weight: 1, amplitude_N: '3'}]",
            ['effects[0].amplitude_N: "3" is not a number (N); write 3'],
        ),
        (
            "[{name: creep, weight: 1, amplitude_N: true}]",
            ["effects[0].amplitude_N: true is not a number (N)"],
        ),
        (
            "[{name: creep, weight: 1.5}]",
            ["effects[0].weight: 1.5 is not a whole number"],
        ),
        (
            "[{name: creep, weight: 1, amplitude_N: -1, rate_ms: 2001}]",
            [
                "effects[0].amplitude_N: -1 N is outside 0 to 500 N, the physical"
                " bounds of creep",
                "effects[0].rate_ms: 2001 ms is outside 4.1 to 2000 ms, the physical"
                " bounds of creep",
            ],
        ),
        (
            "[{name: creep, weight: 1, slope_N_per_mm: 2}]",
            [
                "effects[0].slope_N_per_mm: 2 N/mm is outside -1 to 1 N/mm, the"
                " physical bounds of creep"
            ],
        ),
        (
            "[{name: creep, weight: 1}, {name: creep, weight: 2}]",
            ["effects[1]: creep is listed twice"],
        ),
        (
            "[crep, {name: creep, weight: x}]",
            [
                'effects[0]: "crep" is not an effect; did you mean "creep"?',
                'effects[1].weight: "x" is not a whole number',
            ],
        ),
    ],
)
def test_an_effect_that_cannot_be_built_is_refused(
    write: Write, refusal: Refusal, effects: str, complaints: list[str]
) -> None:
    said = refusal(load, write("m.yaml", text(effects=effects)))
    assert said == [f"m.yaml:10: {complaint}" for complaint in complaints]


def test_the_numbers_of_an_effect_take_their_unit_from_the_key(write: Write) -> None:
    effects = "[{name: creep, amplitude_N: 3, rate_ms: 250, weight: 4, value: 7}]"
    (creep,) = load(write("m.yaml", text(effects=effects))).static.effects
    assert creep == Creep(4, amplitude=3.0, rate=0.25, value=7.0)


def test_a_number_may_lie_on_its_bound_whatever_the_rounding_to_si(
    write: Write,
) -> None:
    effects = "[{name: creep, weight: 1, amplitude_N: 500, rate_ms: 4.1}]"
    (creep,) = load(write("m.yaml", text(effects=effects))).static.effects
    assert creep == Creep(1, amplitude=500.0, rate=4.1 * 1e-3)
