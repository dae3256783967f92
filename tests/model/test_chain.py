"""The chain from valve current to grip force and back."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.optimize import brentq

from gripperd.effects.braid_friction import BraidFriction, Form
from gripperd.effects.jaw_compliance import JawCompliance
from gripperd.effects.linkage_friction import LinkageFriction
from gripperd.effects.pressure_sensor_gain import PressureSensorGain
from gripperd.effects.rubber_elasticity import RubberElasticity
from gripperd.effects.series_compliance import SeriesCompliance
from gripperd.effects.supply_saturation import SupplySaturation
from gripperd.effects.valve_nonlinearity import ValveNonlinearity
from gripperd.effects.valve_offset import ValveOffset
from gripperd.errors import DomainError, InputError
from gripperd.model import Chain, Direction, PressedObject, StaticMuscle

CURRENTS = st.floats(0.004, 0.020)
SIZES = st.floats(0.005, 0.085)
STIFFNESSES = st.one_of(st.just(math.inf), st.floats(2000.0, 1e6))
DIRECTIONS = st.sampled_from(Direction)
FORMS = st.sampled_from(Form)

PAPER_CURRENT = 0.0107


def with_form(chain: Chain, form: Form) -> Chain:
    effects = (RubberElasticity(), BraidFriction(form))
    return replace(chain, static=StaticMuscle(chain.muscle, effects))


@pytest.mark.parametrize(
    ("diameter_mm", "grip"), [(65, 47.6), (58, 39.8), (41, 22.5), (22, 5.6)]
)
def test_one_current_holds_the_four_samples_of_the_paper(
    chain: Chain, diameter_mm: float, grip: float
) -> None:
    prediction = chain.predict(PAPER_CURRENT, PressedObject(diameter_mm * 1e-3))
    assert prediction.grip_force == pytest.approx(grip, abs=0.05)
    assert prediction.pressure == pytest.approx(209.4e3, abs=50)
    assert prediction.contraction == pytest.approx((85 - diameter_mm) / 1000)
    assert prediction.reaches
    assert not prediction.extrapolated


def independent_grip(
    pressure: object, contraction: object, direction: int, **constants: object
) -> np.ndarray:
    """Eqs. (4)-(7) and the virtual work of the jaws, as on paper. [N]."""
    p, h = np.asarray(pressure, float), np.asarray(contraction, float)
    c = {name: np.asarray(value, float) for name, value in constants.items()}
    rest, angle = c["braid_angle"], np.arccos((1 - h) * np.cos(c["braid_angle"]))
    s = np.sin(angle) / np.sin(rest)
    ideal = p * np.pi * c["diameter"] ** 2 / 4
    ideal = ideal * (3 * (1 - h) ** 2 / np.tan(rest) ** 2 - 1 / np.sin(rest) ** 2)
    wall = c["elastic_modulus"] * 0.002
    hoop = (1 - h) ** 2 / np.tan(rest) ** 2 * (1 - 1 / s)
    rubber = wall * np.pi * c["diameter"] * (hoop + h * s)
    contact = (p * c["diameter"] - 2 * wall) * s + 2 * wall
    friction = 0.002 * np.pi * 0.25 * (1 - h) * np.maximum(contact, 0)
    pull = np.maximum(ideal - rubber - direction * friction, 0)
    grip: np.ndarray = (pull - c["spring_preload"] - 1000 * 0.25 * h) / 4
    return grip


CONSTANTS = {
    "braid_angle": math.radians(25),
    "diameter": 0.020,
    "elastic_modulus": 1.3e6,
    "spring_preload": 240.0,
}


@given(current=CURRENTS, opening=SIZES, direction=DIRECTIONS)
def test_the_grip_at_an_opening_is_what_the_equations_give(
    chain: Chain, current: float, opening: float, direction: Direction
) -> None:
    pressure = 500e3 * (current - 0.004) / 0.016
    expected = independent_grip(pressure, 0.085 - opening, direction, **CONSTANTS)
    found = chain.grip_force(current, opening, direction)
    assert found == pytest.approx(float(expected), abs=1e-9)


@given(
    current=CURRENTS,
    diameter=SIZES,
    stiffness=STIFFNESSES,
    direction=DIRECTIONS,
    form=FORMS,
)
def test_the_current_for_a_grip_gives_that_grip(
    chain: Chain,
    current: float,
    diameter: float,
    stiffness: float,
    direction: Direction,
    form: Form,
) -> None:
    rig, pressed = with_form(chain, form), PressedObject(diameter, stiffness)
    assume(rig.grip_force(current, 0.0, direction) < stiffness * diameter)
    grip = rig.grip_on(current, pressed, direction)
    if grip > 0:
        again = rig.current_for(grip, pressed, direction)
        assert again == pytest.approx(current, rel=1e-9)


@given(grip=st.floats(0.5, 80.0), diameter=SIZES, form=FORMS, direction=DIRECTIONS)
def test_a_grip_that_is_asked_for_is_predicted(
    chain: Chain, grip: float, diameter: float, form: Form, direction: Direction
) -> None:
    rig, pressed = with_form(chain, form), PressedObject(diameter, 20e3)
    current = rig.current_for(grip, pressed, direction)
    prediction = rig.predict(current, pressed, direction)
    assert prediction.grip_force == pytest.approx(grip, rel=1e-9)


@given(current=CURRENTS, diameter=SIZES, stiffness=st.floats(1000.0, 1e6))
def test_an_object_that_yields_is_in_balance_with_the_jaws(
    chain: Chain, current: float, diameter: float, stiffness: float
) -> None:
    rigid = float(chain.grip_force(current, diameter))
    assume(chain.grip_force(current, 0.0) < stiffness * diameter)
    grip = chain.grip_on(current, PressedObject(diameter, stiffness))
    if rigid > 0:

        def imbalance(force: float) -> float:
            held = chain.grip_force(current, diameter - force / stiffness)
            return float(held) - force

        assert grip == pytest.approx(brentq(imbalance, 0, rigid, xtol=1e-13), rel=1e-9)
    else:
        assert grip == rigid


def test_a_soft_object_is_in_balance_too(chain: Chain) -> None:
    # By an independent root finder, scipy's brentq.
    assert chain.grip_on(0.0107, PressedObject(0.080, 150.0)) == pytest.approx(
        8.2327, abs=5e-5
    )


def test_an_object_squeezed_flat_is_refused(chain: Chain) -> None:
    with pytest.raises(DomainError, match=r"20 mm and 0\.02 N/mm is squeezed flat"):
        chain.grip_on(0.016, PressedObject(0.020, 20.0))


def test_a_current_that_is_no_number_is_refused(chain: Chain) -> None:
    with pytest.raises(InputError, match="nan"):
        chain.predict(math.nan, PressedObject(0.04))


def test_many_sizes_at_once_equal_one_by_one(chain: Chain) -> None:
    openings = np.linspace(0.005, 0.085, 41)
    grips = np.asarray(chain.grip_force(PAPER_CURRENT, openings))
    currents = np.asarray(chain.current(grips, openings))
    for opening, grip, current in zip(openings, grips, currents, strict=True):
        alone = chain.grip_force(PAPER_CURRENT, float(opening))
        assert grip == pytest.approx(alone, rel=1e-12, abs=1e-12)
        # Where the muscle is slack more than one current leaves it so.
        assert current == pytest.approx(
            chain.current(float(grip), float(opening)), rel=1e-12
        )


@pytest.mark.parametrize("direction", Direction)
def test_the_forces_of_a_prediction_are_in_balance(
    chain: Chain, direction: Direction
) -> None:
    seen = chain.predict(PAPER_CURRENT, PressedObject(0.058, 5000.0), direction)
    assert seen.direction is direction
    assert seen.opening == pytest.approx(0.058 - seen.grip_force / 5000.0)
    assert seen.contraction == pytest.approx(0.085 - seen.opening)
    assert seen.spring_force == pytest.approx(240 + 250 * seen.contraction)
    assert seen.muscle_force == pytest.approx(4 * seen.grip_force + seen.spring_force)


def test_a_grasp_beyond_the_catalogue_range_is_marked(chain: Chain) -> None:
    direct = replace(chain, linkage=replace(chain.linkage, ratio=1.0))
    assert direct.predict(0.020, PressedObject(0.020)).extrapolated
    assert not direct.predict(0.020, PressedObject(0.025)).extrapolated


def test_jaws_that_do_not_reach_the_object_do_not_press_it(chain: Chain) -> None:
    prediction = chain.predict(0.006, PressedObject(0.041))
    assert chain.grip_on(0.006, PressedObject(0.041)) < 0
    assert prediction.grip_force == 0.0
    assert not prediction.reaches


def test_the_same_current_grips_harder_on_the_way_back(chain: Chain) -> None:
    pressed = PressedObject(0.041)
    closing = chain.predict(PAPER_CURRENT, pressed, Direction.CONTRACTING)
    opening = chain.predict(PAPER_CURRENT, pressed, Direction.EXTENDING)
    assert opening.grip_force > closing.grip_force


def test_an_object_wider_than_the_open_jaws_is_refused(chain: Chain) -> None:
    with pytest.raises(DomainError, match=r"90 mm does not fit.*open 85 mm") as refusal:
        chain.predict(PAPER_CURRENT, PressedObject(0.090))
    assert refusal.value.key == "diameter_mm"
    assert chain.predict(PAPER_CURRENT, PressedObject(0.085)).contraction == 0.0


TOLERANCES = {
    "muscle.diameter": 0.05e-3,
    "muscle.braid_angle": math.radians(0.05),
    "muscle.elastic_modulus": 0.03e6,
    "valve.pressure_low": 1.5e3,
    "gripper.spring_preload": 4.0,
}


@pytest.mark.parametrize("stiffness", [math.inf, 20e3])
@pytest.mark.parametrize("diameter", [0.065, 0.041])
def test_the_standard_deviation_is_that_of_many_rigs(
    chain: Chain, diameter: float, stiffness: float
) -> None:
    known_to_within = replace(chain, tolerances=TOLERANCES)
    rng, count = np.random.default_rng(20240607), 200_000
    drawn = {
        path.partition(".")[2]: sigma * rng.standard_normal(count)
        for path, sigma in TOLERANCES.items()
    }
    constants = {name: value + drawn[name] for name, value in CONSTANTS.items()}
    low = drawn["pressure_low"]
    pressure = low + (500e3 - low) * (PAPER_CURRENT - 0.004) / 0.016
    grips = np.zeros(count)
    for _ in range(12):
        contraction = 0.085 - diameter + grips / stiffness
        grips = independent_grip(pressure, contraction, 1, **constants)
    expected = float(np.std(grips))
    # Three standard deviations of a standard deviation estimated from this many draws.
    sampling = 3 * expected / math.sqrt(2 * count)
    found = known_to_within.std(PAPER_CURRENT, PressedObject(diameter, stiffness))
    assert found == pytest.approx(expected, abs=sampling)


def test_constants_that_were_fitted_together_are_off_together(chain: Chain) -> None:
    """Of many rigs, drawn from a covariance in which diameter and modulus cancel."""
    names = ("diameter", "elastic_modulus", "spring_preload")
    sigmas = np.array([0.2e-3, 0.1e6, 4.0])
    coefficients = np.array([[1.0, 0.95, 0.0], [0.95, 1.0, -0.3], [0.0, -0.3, 1.0]])
    rng, count = np.random.default_rng(20240608), 200_000
    covariance = coefficients * np.outer(sigmas, sigmas)
    drawn = rng.multivariate_normal(np.zeros(3), covariance, count).T
    constants = CONSTANTS | {
        name: CONSTANTS[name] + off for name, off in zip(names, drawn, strict=True)
    }
    pressure = 500e3 * (PAPER_CURRENT - 0.004) / 0.016
    expected = float(np.std(independent_grip(pressure, 0.044, 1, **constants)))
    paths = [f"muscle.{name}" for name in names[:2]] + ["gripper.spring_preload"]
    known = replace(
        chain,
        tolerances=dict(zip(paths, sigmas.tolist(), strict=True)),
        correlations={
            (paths[0], paths[1]): 0.95,
            (paths[2], paths[1]): -0.3,
            ("valve.pressure_low", paths[0]): 0.9,
        },
    )
    sampling = 3 * expected / math.sqrt(2 * count)
    pressed = PressedObject(0.041)
    found = known.std(PAPER_CURRENT, pressed)
    assert found == pytest.approx(expected, abs=sampling)
    assert found < 0.8 * replace(known, correlations={}).std(PAPER_CURRENT, pressed)


def test_constants_known_exactly_leave_no_doubt(chain: Chain) -> None:
    assert chain.predict(PAPER_CURRENT, PressedObject(0.041)).grip_std == 0.0


@pytest.mark.parametrize(
    ("path", "by"),
    [
        ("muscle.diameter", 1e-3),
        ("valve.pressure_high", 1e4),
        ("gripper.ratio", 0.1),
    ],
)
def test_a_varied_chain_differs_in_one_constant(
    chain: Chain, path: str, by: float
) -> None:
    owner, _, constant = path.partition(".")
    parts = {"muscle": "muscle", "valve": "regulator", "gripper": "linkage"}

    def value(rig: Chain) -> float:
        return float(getattr(getattr(rig, parts[owner]), constant))

    varied = chain.varied(path, by)
    assert value(varied) == pytest.approx(value(chain) + by)
    assert varied.varied(path, -by).name == chain.name
    assert value(chain.varied(path, 0.0)) == value(chain)


def test_a_tolerance_on_nothing_is_an_error_not_a_zero(chain: Chain) -> None:
    with pytest.raises(KeyError, match=r"effects\.creep\.amplitude"):
        chain.varied("effects.creep.amplitude", 1.0)


ALL_ALONG = (
    ValveOffset(offset=4e3),
    ValveNonlinearity(bow=6e3),
    LinkageFriction(loss=0.08, pull_loss=0.01),
    JawCompliance(compliance=2e-5),
    SeriesCompliance(compliance=5e-6, shortening=1e-5),
    PressureSensorGain(error=0.1),
)


@given(current=CURRENTS, diameter=SIZES, stiffness=STIFFNESSES, direction=DIRECTIONS)
def test_with_effects_everywhere_the_current_for_a_grip_gives_that_grip(
    chain: Chain,
    current: float,
    diameter: float,
    stiffness: float,
    direction: Direction,
) -> None:
    rig, pressed = replace(chain, effects=ALL_ALONG), PressedObject(diameter, stiffness)
    assume(rig.grip_force(current, 0.0, direction) < stiffness * diameter)
    grip = rig.grip_on(current, pressed, direction)
    if grip > 0:
        again = rig.current_for(grip, pressed, direction)
        assert again == pytest.approx(current, rel=1e-9)


def test_a_valve_that_gives_more_grips_as_with_more_current(chain: Chain) -> None:
    # 5 kPa are 0.16 mA of a line of 31.25 kPa a milliampere.
    offset = replace(chain, effects=(ValveOffset(offset=5e3),))
    pressed = PressedObject(0.041)
    more = chain.predict(PAPER_CURRENT + 0.16e-3, pressed)
    seen = offset.predict(PAPER_CURRENT, pressed)
    assert seen.grip_force == pytest.approx(more.grip_force, rel=1e-12)
    assert seen.pressure == pytest.approx(209_375 + 5e3)
    assert offset.outlet.pressure(PAPER_CURRENT) == seen.pressure


def test_joints_that_rub_take_their_share_of_the_grip(chain: Chain) -> None:
    rubbing = replace(chain, effects=(LinkageFriction(loss=0.1),))
    for direction, kept in ((Direction.CONTRACTING, 0.9), (Direction.EXTENDING, 1.1)):
        free = chain.grip_force(PAPER_CURRENT, 0.05, direction)
        assert rubbing.grip_force(PAPER_CURRENT, 0.05, direction) == pytest.approx(
            kept * float(free)
        )


def test_fingers_that_bend_are_a_softer_object_to_the_muscle(chain: Chain) -> None:
    # 1/k of the object, 0.1 mm/N, and 0.02 mm/N of the fingers.
    bending = replace(chain, effects=(JawCompliance(compliance=2e-5),))
    seen = bending.predict(PAPER_CURRENT, PressedObject(0.058, 1e4))
    softer = chain.predict(PAPER_CURRENT, PressedObject(0.058, 1 / 1.2e-4))
    assert seen.grip_force == pytest.approx(softer.grip_force, rel=1e-9)
    assert seen.contraction == pytest.approx(softer.contraction, rel=1e-9)
    assert seen.opening == pytest.approx(0.058 - seen.grip_force / 1e4)


def test_with_effects_the_forces_of_a_prediction_are_in_balance(chain: Chain) -> None:
    rig = replace(chain, effects=ALL_ALONG)
    seen = rig.predict(PAPER_CURRENT, PressedObject(0.058, 5000.0))
    passed = 0.92 * (seen.muscle_force - seen.spring_force) / 4
    assert seen.grip_force == pytest.approx(passed - 0.01 * seen.muscle_force)
    bent = 2e-5 * seen.grip_force + 5e-6 * seen.muscle_force
    assert seen.opening == pytest.approx(0.085 - seen.contraction + bent)


def test_a_current_is_refused_for_a_pressure_the_supply_cannot_give(
    chain: Chain,
) -> None:
    short = replace(chain, effects=(SupplySaturation(share=1.0, limit=0.5),))
    pressed = PressedObject(0.058)
    possible = short.predict(0.020, pressed).grip_force
    assert short.current_for(possible - 0.1, pressed) < 0.0121
    with pytest.raises(DomainError, match="supply_saturation"):
        short.current_for(possible + 0.1, pressed)


def test_sensors_do_not_change_what_is(chain: Chain) -> None:
    misread = replace(chain, effects=(PressureSensorGain(error=0.1),))
    pressed = PressedObject(0.041, 1e4)
    assert misread.predict(PAPER_CURRENT, pressed) == chain.predict(
        PAPER_CURRENT, pressed
    )


def test_a_known_pressure_grips_like_the_current_that_gives_it(chain: Chain) -> None:
    for rig in (chain, replace(chain, effects=ALL_ALONG)):
        pressure = rig.outlet.pressure(PAPER_CURRENT)
        assert rig.grip_at(pressure, 0.05) == rig.grip_force(PAPER_CURRENT, 0.05)


def test_constants_of_effects_outside_the_muscle_may_be_uncertain(
    chain: Chain,
) -> None:
    rig = replace(
        chain,
        effects=(ValveOffset(offset=4e3), LinkageFriction(loss=0.1)),
        tolerances={"effects.linkage_friction.loss": 0.01},
    )
    varied = rig.varied("effects.linkage_friction.loss", 0.05)
    offset, friction = varied.effects
    assert offset == ValveOffset(offset=4e3)
    assert isinstance(friction, LinkageFriction)
    assert friction.loss == pytest.approx(0.15)
    free = float(
        replace(chain, effects=rig.effects[:1]).grip_force(PAPER_CURRENT, 0.05)
    )
    assert rig.std(PAPER_CURRENT, PressedObject(0.05)) == pytest.approx(0.01 * free)
