from dataclasses import replace
from math import isclose

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gripperd.control.setpoint import LONGEST_STEP, Ramp, reached, within
from gripperd.effects.supply_saturation import SupplySaturation
from gripperd.effects.valve_offset import ValveOffset
from gripperd.model import Chain
from gripperd.signals import Measurement, Reading

currents = st.floats(0.0, 0.02)


@given(currents, currents, st.floats(1e-5, 1.0))
def test_a_ramp_never_passes_its_goal_and_arrives_exactly(
    start: float, goal: float, rate: float
) -> None:
    ramp, step = Ramp(start), rate * 0.01
    arrived = ramp.towards(goal, rate, 0.01)
    assert min(start, goal) <= ramp.current <= max(start, goal)
    assert arrived == (ramp.current == goal)
    assert arrived or isclose(abs(ramp.current - start), step, rel_tol=1e-6)
    steps = int(abs(goal - start) / step) + 2
    for _ in range(min(steps, 100)):
        ramp.towards(goal, rate, 0.01)
    assert steps > 100 or ramp.current == goal


def test_a_stall_is_not_made_up_for_in_one_step() -> None:
    ramp = Ramp(0.004)
    ramp.towards(0.020, 0.008, 5.0)
    assert ramp.current == pytest.approx(0.004 + 0.008 * LONGEST_STEP)


@pytest.fixture
def closing() -> Ramp:
    """On its way from 4 mA with 8 mA/s, now at 12 mA; 120 ms ago at 11.0 mA."""
    ramp = Ramp(0.004)
    for _ in range(100):
        ramp.tick(0.01)
        ramp.towards(0.020, 0.008, 0.01)
    return ramp


@pytest.mark.parametrize(
    ("reached", "rests"),
    [(0.0115, 0.0115), (0.0150, 0.0120), (0.0050, 0.0110), (None, 0.0115)],
    ids=["true valve", "valve gives more", "valve gives less", "no sensor"],
)
def test_a_ramp_rests_where_it_has_been_lately(
    closing: Ramp, reached: float | None, rests: float
) -> None:
    closing.rest(reached)
    assert closing.current == pytest.approx(rests, abs=0.0001)


def test_a_current_that_has_stood_still_stays_when_it_rests() -> None:
    ramp = Ramp(0.004)
    ramp.towards(0.010, 1.0, 0.01)
    for _ in range(20):
        ramp.tick(0.01)
    ramp.rest(0.013)
    assert ramp.current == 0.010


@pytest.mark.parametrize(
    ("asked", "given_"),
    [(0.0, 0.004), (0.004, 0.004), (0.012, 0.012), (0.02, 0.02), (0.03, 0.02)],
)
def test_the_valve_follows_only_its_span(
    chain: Chain, asked: float, given_: float
) -> None:
    assert within(chain.regulator, asked) == given_


def at(pressure: float | None) -> Measurement:
    found = Reading.bad("broken") if pressure is None else Reading(pressure)
    return Measurement(time=0.0, current=Reading(0.0107), pressure=found)


def test_a_pressure_belongs_to_the_current_that_the_valve_of_the_model_takes(
    chain: Chain,
) -> None:
    high = replace(chain, effects=(ValveOffset(offset=20e3),))
    # 10.7 mA are 209.375 kPa on the line, and 20 kPa more by this model.
    assert reached(at(209_375.0), chain) == pytest.approx(0.0107)
    assert reached(at(229_375.0), high) == pytest.approx(0.0107)


def test_a_pressure_that_the_valve_cannot_give_tells_no_current(chain: Chain) -> None:
    spent = replace(chain, effects=(SupplySaturation(share=1.0, limit=0.3),))
    assert reached(at(149e3), spent) == pytest.approx(0.004 + 0.016 * 149 / 500)
    assert reached(at(151e3), spent) is None
    assert reached(at(None), chain) is None
