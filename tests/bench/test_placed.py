import pytest

from gripperd.bench.object import BenchObject
from gripperd.bench.placed import ObjectState, PlacedObject
from gripperd.bench.settings import PlantSettings

SETTINGS = PlantSettings(lift_delay=0.25, lift_acceleration=2.0)
EGG = BenchObject(
    diameter=0.041, stiffness=3e4, mass=0.060, friction=0.4, damage_force=35.0
)
SLIP_FORCE = 0.060 * (9.80665 + 2.0) / (2 * 0.4)


def pressed(grip: float, seconds: float) -> PlacedObject:
    placed = PlacedObject(EGG, SETTINGS)
    for _ in range(round(seconds / 1e-3)):
        placed.step(grip, 1e-3)
    return placed


def test_an_object_is_lifted_once_the_grip_has_been_steady() -> None:
    assert pressed(5.0, 0.250).state is ObjectState.RESTING
    assert pressed(5.0, 0.252).state is ObjectState.HELD


def test_an_untouched_object_stays_on_its_support() -> None:
    placed = pressed(0.0, 1.0)
    assert placed.state is ObjectState.RESTING
    assert placed.at_rest


def test_a_rising_grip_is_waited_for() -> None:
    placed = PlacedObject(EGG, SETTINGS)
    for step in range(2000):
        placed.step(1.0 + 0.001 * step, 1e-3)
    assert placed.state is ObjectState.RESTING


def test_it_holds_at_the_slip_force_and_slips_below() -> None:
    assert pressed(SLIP_FORCE * 1.0001, 2.0).state is ObjectState.HELD
    assert pressed(SLIP_FORCE * 0.9, 0.26).state is ObjectState.SLIPPING


def test_a_slipping_object_is_not_at_rest_when_lifted() -> None:
    placed = pressed(SLIP_FORCE * 0.9, 0.0)
    while placed.state is ObjectState.RESTING:
        placed.step(SLIP_FORCE * 0.9, 1e-3)
    assert not placed.at_rest


def test_it_is_lost_after_its_own_radius() -> None:
    placed = pressed(0.5 * SLIP_FORCE, 0.252)
    time = 0.0
    while placed.state is not ObjectState.LOST:
        placed.step(0.5 * SLIP_FORCE, 1e-5)
        time += 1e-5
    # Half the weight is carried: s = (g + a) / 4 · t².
    assert time == pytest.approx((4 * 0.0205 / 11.80665) ** 0.5, abs=2e-3)
    assert placed.stiffness == 0.0


def test_a_firmer_grip_catches_a_slipping_object() -> None:
    placed = pressed(0.9 * SLIP_FORCE, 0.28)
    before = placed.slid
    for _ in range(300):
        placed.step(5 * SLIP_FORCE, 1e-3)
    assert placed.state is ObjectState.HELD
    assert before > 0
    assert 0 < placed.slid < 0.0205


def test_a_lifted_object_that_is_let_go_falls() -> None:
    placed = pressed(5.0, 0.3)
    for _ in range(100):
        placed.step(0.0, 1e-3)
    assert placed.state is ObjectState.LOST


def test_a_crack_stays() -> None:
    placed = PlacedObject(EGG, SETTINGS)
    cracked = []
    for grip in (35.0, 35.1, 36.0, 1.0):
        placed.step(grip, 1e-3)
        cracked.append(placed.cracked)
    assert cracked == [False, True, True, True]
    assert placed.stiffness == pytest.approx(0.2 * 3e4)


def test_what_slides_down_is_narrower_where_the_pads_touch_it() -> None:
    placed = pressed(0.5 * SLIP_FORCE, 0.252)
    while placed.slid < 0.010:
        placed.step(0.5 * SLIP_FORCE, 1e-5)
    # Pythagoras: a chord 10 mm below the middle of a ball of 41 mm.
    assert placed.width == pytest.approx(
        2 * (20.5**2 - 10.0**2) ** 0.5 * 1e-3, rel=1e-3
    )


def test_ice_on_the_pads_lets_it_fall_freely() -> None:
    placed = pressed(10 * SLIP_FORCE, 0.3)
    placed.disturb(friction=0.0, pull=0.0)
    time = 0.0
    while placed.state is not ObjectState.LOST:
        placed.step(10 * SLIP_FORCE, 1e-5)
        time += 1e-5
    assert time == pytest.approx((2 * 0.0205 / 11.80665) ** 0.5, abs=1e-4)


def test_a_pull_counts_like_weight() -> None:
    # At three times the slip force, twice the weight may be added, and no more.
    load = 0.060 * 11.80665
    for pull, state in ((1.99 * load, "held"), (2.01 * load, "slipping")):
        placed = pressed(3 * SLIP_FORCE, 0.3)
        placed.disturb(friction=1.0, pull=pull)
        placed.step(3 * SLIP_FORCE, 1e-3)
        assert placed.state == state
