from math import isclose

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gripperd.control.setpoint import LONGEST_STEP, Ramp, within
from gripperd.model import Chain

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
