from dataclasses import replace
from math import cos, pi, radians, sin, sqrt, tan

import pytest
from scipy.optimize import brentq

from gripperd.bench.faults import BenchFaults
from gripperd.bench.object import BenchObject
from gripperd.bench.placed import ObjectState
from gripperd.bench.plant import Plant
from gripperd.bench.settings import PlantSettings
from gripperd.errors import InputError
from gripperd.model import Chain, Direction

SETTINGS = PlantSettings()
SIZES = {"apple": 0.065, "peach": 0.058, "egg": 0.041, "grape": 0.022}


def pull(pressure: float, shortening: float, sign: float) -> float:
    """The paper's eqs. (4)-(7) with its constants, brace moved; sign +1 contracting."""
    h = shortening / 0.25
    angle, diameter, modulus, wall, mu = radians(25), 0.02, 1.3e6, 0.002, 0.002
    s = sqrt(1 - ((1 - h) * cos(angle)) ** 2) / sin(angle)
    ideal = pi * diameter**2 / 4 * (3 * (1 - h) ** 2 / tan(angle) ** 2)
    ideal = pressure * (ideal - pi * diameter**2 / 4 / sin(angle) ** 2)
    hoop = (1 - h) ** 2 / tan(angle) ** 2 * (1 - 1 / s)
    rubber = modulus * wall * pi * diameter * (hoop + h * s)
    support = 2 * modulus * wall
    load = (pressure * diameter - support) * s + support
    return ideal - rubber - sign * mu * pi * 0.25 * (1 - h) * max(load, 0.0)


def balance(pressure: float, diameter: float, stiffness: float, sign: float) -> float:
    """Grip force at which pull, spring and object are in balance."""

    def surplus(opening: float) -> float:
        shortening = (0.085 - opening) / 4
        grip = stiffness * max(0.0, diameter - opening)
        return pull(pressure, shortening, sign) - 240 - 1000 * shortening - 4 * grip

    opening = float(brentq(surplus, 0.0, 0.085, xtol=1e-14))
    return stiffness * max(0.0, diameter - opening)


def sturdy(
    diameter: float, stiffness: float = 2e5, *, mass: float = 0.05
) -> BenchObject:
    """An object that neither slips nor breaks under what the tests do to it."""
    return BenchObject(
        diameter=diameter,
        stiffness=stiffness,
        mass=mass,
        friction=0.5,
        damage_force=500.0,
    )


def run(plant: Plant, seconds: float, dt: float = 1e-3) -> None:
    for _ in range(round(seconds / dt)):
        plant.step(dt)


def grasping(chain: Chain, kind: BenchObject, current: float = 0.0107) -> Plant:
    """A plant two seconds after a step of current onto an object."""
    plant = Plant(chain, SETTINGS)
    plant.place(kind)
    plant.current = current
    run(plant, 2.0)
    return plant


@pytest.mark.parametrize("stiffness", [2e3, 2e4, 2e5])
@pytest.mark.parametrize("diameter", SIZES.values(), ids=SIZES)
def test_a_settled_grasp_is_the_static_balance(
    chain: Chain, diameter: float, stiffness: float
) -> None:
    plant = grasping(chain, sturdy(diameter, stiffness))
    expected = balance(209_375.0, diameter, stiffness, +1)
    assert plant.grip == pytest.approx(expected, rel=5e-3)
    assert plant.direction is Direction.CONTRACTING
    assert plant.at_rest


@pytest.mark.parametrize(
    ("size", "force"), [("apple", 47.6), ("peach", 39.8), ("egg", 22.5), ("grape", 5.6)]
)
def test_one_current_holds_four_sizes_as_in_the_paper(
    chain: Chain, size: str, force: float
) -> None:
    plant = grasping(chain, sturdy(SIZES[size], 2e6, mass=0.01))
    assert plant.grip == pytest.approx(force, abs=0.06)
    assert plant.placed is not None
    assert plant.placed.state is ObjectState.HELD


@pytest.mark.parametrize("dt", [5e-4, 2e-3])
def test_the_step_does_not_change_the_settled_force(chain: Chain, dt: float) -> None:
    plant = Plant(chain, SETTINGS)
    plant.place(sturdy(0.041))
    plant.current = 0.0107
    run(plant, 2.0, dt)
    assert plant.grip == pytest.approx(balance(209_375.0, 0.041, 2e5, +1), rel=1e-3)


def test_the_jaws_close_in_the_time_that_was_measured(chain: Chain) -> None:
    ends = Plant(chain, SETTINGS)
    ends.current = 0.0107
    run(ends, 2.0)
    plant = Plant(chain, SETTINGS)
    plant.current = 0.0107
    while plant.opening > 0.085 - 0.63 * (0.085 - ends.opening):
        plant.step(1e-3)
    assert 0.060 <= plant.time <= 0.130


def test_empty_jaws_rest_at_the_free_balance_without_force(chain: Chain) -> None:
    plant = Plant(chain, SETTINGS)
    plant.current = 0.0107
    run(plant, 2.0)
    free = brentq(lambda x: pull(209_375.0, x, 1) - 240 - 1000 * x, 0.0, 0.085 / 4)
    assert plant.contraction == pytest.approx(free / 0.25, rel=1e-3)
    assert plant.grip == 0.0
    assert plant.velocity == 0.0


def test_empty_jaws_close_to_the_stop_at_full_current(chain: Chain) -> None:
    plant = Plant(chain, SETTINGS)
    plant.current = 0.020
    run(plant, 1.0)
    assert plant.opening == 0.0
    assert plant.grip == 0.0


def test_nothing_moves_below_the_preload(chain: Chain) -> None:
    # The muscle pulls 240 N at rest length at 94.3 kPa, or 7.02 mA.
    threshold = 0.004 + brentq(lambda p: pull(p, 0, 1) - 240, 0, 5e5) / 500e3 * 0.016
    plant = Plant(chain, SETTINGS)
    plant.current = threshold - 2e-5
    run(plant, 1.0)
    assert plant.opening == 0.085
    plant.current = threshold + 2e-5
    run(plant, 1.0)
    assert 0.080 < plant.opening < 0.085


def test_a_grasp_reached_from_above_differs_by_the_friction(chain: Chain) -> None:
    kind = sturdy(0.041, 2e4)
    closing = grasping(chain, kind)
    relaxing = grasping(chain, kind, current=0.0125)
    relaxing.current = 0.0107
    run(relaxing, 2.0)
    assert relaxing.direction is Direction.EXTENDING
    assert relaxing.grip == pytest.approx(balance(209_375.0, 0.041, 2e4, -1), rel=5e-3)
    assert relaxing.grip > closing.grip + 2.0


def test_inside_the_friction_band_the_grip_does_not_change(chain: Chain) -> None:
    plant = grasping(chain, sturdy(0.041))
    before = plant.grip
    plant.current = 0.0106
    run(plant, 1.0)
    assert plant.pressure == pytest.approx(206_250.0)
    assert plant.grip == before


def test_the_jaws_open_again_when_the_current_is_taken_away(chain: Chain) -> None:
    plant = grasping(chain, sturdy(0.041))
    plant.current = 0.0
    run(plant, 2.0)
    assert plant.opening == 0.085
    assert plant.pressure == 0.0


@pytest.mark.parametrize(
    ("current", "pressure"), [(0.0, 0.0), (0.002, 0.0), (0.012, 250e3), (0.022, 500e3)]
)
def test_the_regulator_keeps_inside_its_span(
    chain: Chain, current: float, pressure: float
) -> None:
    plant = Plant(chain, SETTINGS)
    plant.current = current
    run(plant, 2.0)
    assert plant.outlet_pressure == plant.pressure == pressure


def test_the_regulator_vents_no_further_than_its_low_end(chain: Chain) -> None:
    regulator = replace(chain.regulator, pressure_low=20e3)
    plant = Plant(replace(chain, regulator=regulator), SETTINGS)
    run(plant, 2.0)
    assert plant.pressure == 20e3


def test_a_slack_muscle_does_not_push_the_jaws_open(chain: Chain) -> None:
    limp = replace(chain.linkage, spring_preload=0.0, spring_rate=0.0)
    plant = Plant(replace(chain, linkage=limp), SETTINGS)
    plant.current = 0.005
    run(plant, 2.0)
    closed = plant.opening
    plant.current = 0.0
    run(plant, 2.0)
    assert plant.pressure == 0.0
    assert plant.opening == closed < 0.080


def test_low_supply_limits_the_force(chain: Chain) -> None:
    plant = Plant(chain, SETTINGS)
    plant.place(sturdy(0.065))
    plant.faults = BenchFaults(supply_pressure=160e3)
    plant.current = 0.0107
    run(plant, 2.0)
    assert plant.pressure == 160e3
    assert plant.grip == pytest.approx(balance(160e3, 0.065, 2e5, +1), rel=5e-3)
    plant.faults = BenchFaults()
    run(plant, 2.0)
    assert plant.grip == pytest.approx(47.4, abs=0.1)


def test_a_leak_costs_pressure(chain: Chain) -> None:
    plant = grasping(chain, sturdy(0.065))
    plant.faults = BenchFaults(leak_rate=10.0)
    run(plant, 2.0)
    assert plant.pressure == pytest.approx(209_375.0 / 1.2, rel=1e-6)


def test_sticky_jaws_take_their_friction_off_the_grip(chain: Chain) -> None:
    plant = Plant(chain, SETTINGS)
    plant.place(sturdy(0.041, 2e6))
    plant.faults = BenchFaults(jaw_friction=5.0)
    plant.current = 0.0107
    run(plant, 2.0)
    assert plant.grip == pytest.approx(22.5 - 5.0, abs=0.1)


@pytest.mark.parametrize(("excess", "state"), [(0.98, "held"), (1.02, "lost")])
def test_an_object_heavier_than_the_friction_carries_is_lost(
    chain: Chain, excess: float, state: str
) -> None:
    grip = balance(209_375.0, 0.041, 2e5, +1)
    mass = excess * 2 * 0.5 * grip / (9.80665 + SETTINGS.lift_acceleration)
    plant = grasping(chain, sturdy(0.041, mass=mass))
    run(plant, 3.0)
    assert plant.placed is not None
    assert plant.placed.state == state
    assert (plant.grip == 0.0) == (state == "lost")
    assert (plant.opening < 0.040) == (state == "lost")


def test_an_offset_of_the_valve_cracks_an_egg_for_good(chain: Chain) -> None:
    egg = BenchObject(
        diameter=0.041, stiffness=3e4, mass=0.060, friction=0.4, damage_force=35.0
    )
    plant = grasping(chain, egg)
    assert plant.placed is not None
    cracked = []
    grips = []
    for offset in (0.0, 60e3, 0.0):
        plant.faults = BenchFaults(valve_offset=offset)
        run(plant, 2.0)
        cracked.append(plant.placed.cracked)
        grips.append(plant.grip)
    assert cracked == [False, True, True]
    # What is left of the shell gives way: the jaws go on until they balance.
    assert grips[1] == pytest.approx(balance(269_375.0, 0.041, 6e3, +1), rel=5e-3)


def test_an_object_pulled_out_leaves_empty_jaws(chain: Chain) -> None:
    plant = grasping(chain, sturdy(0.041))
    plant.remove()
    assert plant.grip == 0.0
    run(plant, 1.0)
    assert plant.placed is None
    assert plant.opening < 0.022


def test_an_object_wider_than_the_opening_is_refused_with_both_sizes(
    chain: Chain,
) -> None:
    plant = Plant(chain, SETTINGS)
    with pytest.raises(InputError, match=r"90 mm does not fit.*85 mm apart"):
        plant.place(sturdy(0.090))
    assert plant.placed is None


def test_a_second_object_is_refused_until_the_first_is_gone(chain: Chain) -> None:
    plant = Plant(chain, SETTINGS)
    plant.place(sturdy(0.041))
    with pytest.raises(InputError, match="an object of 41 mm is still"):
        plant.place(sturdy(0.022))
    plant.remove()
    plant.place(sturdy(0.022))
    assert plant.placed is not None
    assert plant.placed.kind.diameter == 0.022


@pytest.mark.parametrize("current", [-0.001, float("nan"), float("inf")])
def test_a_current_no_module_gives_is_refused(chain: Chain, current: float) -> None:
    plant = Plant(chain, SETTINGS)
    with pytest.raises(InputError, match="current_mA"):
        plant.current = current
    assert plant.current == 0.0


def test_a_plant_at_rest_stays_as_it_is_over_any_time(chain: Chain) -> None:
    plant = grasping(chain, sturdy(0.041))
    before = (plant.pressure, plant.opening, plant.grip)
    plant.step(3600.0)
    assert (plant.pressure, plant.opening, plant.grip) == before
    assert plant.time == pytest.approx(3602.0)


def test_the_same_commands_give_the_same_motion(chain: Chain) -> None:
    first, second = (grasping(chain, sturdy(0.058)) for _ in range(2))
    assert first.grip == second.grip
    assert first.opening == second.opening


def test_blocked_jaws_stand_whatever_the_pressure(chain: Chain) -> None:
    plant = Plant(chain, PlantSettings())
    plant.faults = BenchFaults(jaws_blocked=True)
    plant.current = 0.020
    run(plant, 2.0)
    assert plant.pressure == pytest.approx(500e3)
    assert plant.opening == chain.linkage.open_width


def test_a_stuck_valve_keeps_its_pressure_until_it_is_mended(chain: Chain) -> None:
    plant = Plant(chain, PlantSettings())
    plant.current = 0.0107
    run(plant, 2.0)
    plant.faults = BenchFaults(valve_stuck=True)
    plant.current = 0.004
    run(plant, 2.0)
    # 10.7 mA of 4 to 20 mA on 500 kPa.
    assert plant.pressure == pytest.approx(209_375.0)
    plant.faults = BenchFaults()
    run(plant, 2.0)
    assert plant.pressure == pytest.approx(0.0)
