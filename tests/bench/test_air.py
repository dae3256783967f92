from math import exp

import pytest

from gripperd.bench.air import Air
from gripperd.bench.settings import PlantSettings

SETTINGS = PlantSettings()


def time_to(air: Air, target: float, part: float) -> float:
    """Time the outlet takes to go a part of the way to a target."""
    start = air.outlet
    time = 0.0
    while abs(air.outlet - start) < part * abs(target - start):
        air.step(target, 0.0, 1e-4)
        time += 1e-4
    return time


def test_the_muscle_fills_as_two_lags_in_series() -> None:
    air = Air(SETTINGS)
    slow, fast = 0.040, 0.020
    for _ in range(1000):
        air.step(300e3, 0.0, 1e-4)
    time = 0.1
    expected = 300e3 * (
        1 - (slow * exp(-time / slow) - fast * exp(-time / fast)) / (slow - fast)
    )
    assert air.chamber == pytest.approx(expected, rel=2e-3)


def test_the_outlet_rises_by_two_thirds_in_one_lag() -> None:
    assert time_to(Air(SETTINGS), 400e3, 0.632) == pytest.approx(0.040, abs=2e-4)


def test_emptying_takes_half_as_long_again_as_filling() -> None:
    air = Air(SETTINGS)
    filling = time_to(air, 400e3, 0.5)
    for _ in range(1000):
        air.step(400e3, 0.0, 1e-2)
    emptying = time_to(air, 0.0, 0.5)
    assert emptying / filling == pytest.approx(1.5, rel=0.01)


def test_the_step_does_not_change_where_it_goes() -> None:
    coarse, fine = Air(SETTINGS), Air(SETTINGS)
    for _ in range(10):
        coarse.step(300e3, 0.0, 0.01)
    for _ in range(1000):
        fine.step(300e3, 0.0, 1e-4)
    assert coarse.outlet == pytest.approx(fine.outlet, rel=1e-9)
    assert coarse.chamber == pytest.approx(fine.chamber, rel=0.1)


def test_a_leak_is_balanced_by_the_flow_through_the_tube() -> None:
    air = Air(SETTINGS)
    for _ in range(2000):
        air.step(300e3, 50.0, 1e-3)
    inflow = (air.outlet - air.chamber) / 0.020
    assert air.settled
    assert inflow == pytest.approx(50.0 * air.chamber, rel=1e-9)


def test_both_pressures_settle_exactly() -> None:
    air = Air(SETTINGS)
    settled = []
    for _ in range(2000):
        air.step(300e3, 0.0, 1e-3)
        settled.append(air.settled)
    assert not settled[0]
    assert settled[-1]
    assert air.outlet == air.chamber == 300e3
