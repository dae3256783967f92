from collections.abc import Mapping
from dataclasses import replace
from math import sqrt

import pytest

from gripperd.control.plan import Plan
from gripperd.control.profile import Mode, Profile
from gripperd.effects.supply_saturation import SupplySaturation
from gripperd.effects.valve_offset import ValveOffset
from gripperd.model import Chain, Direction, PressedObject

from .stage import ordered

Profiles = Mapping[str, Profile]


@pytest.fixture
def plan(chain: Chain, profiles: Profiles) -> Plan:
    """12 N on an egg."""
    return Plan(ordered(profiles["raw_egg"], Mode.FORCE), chain)


def test_the_goal_gives_what_was_ordered(plan: Plan, chain: Chain) -> None:
    # 12 N press 0.12 mm into an egg of 41 mm.
    assert chain.grip_force(plan.goal, 0.041 - 0.12e-3) == pytest.approx(12.0)


def test_an_object_that_was_felt_is_aimed_at_anew(plan: Plan, chain: Chain) -> None:
    plan.touch(0.0425)
    assert chain.grip_force(plan.goal, 0.0425 - 0.12e-3) == pytest.approx(12.0)


def test_a_fixed_current_is_the_goal_whatever_is_felt(
    chain: Chain, profiles: Profiles
) -> None:
    plan = Plan(ordered(profiles["raw_egg"], Mode.CURRENT), chain)
    plan.touch(0.0425)
    assert plan.goal == plan.closing_limit == 0.0107


def test_free_jaws_slow_down_before_the_largest_object(
    plan: Plan, chain: Chain
) -> None:
    # 41 mm, 4 mm larger, 2 mm to spare.
    assert chain.grip_force(plan.near, 0.047) == pytest.approx(0.0, abs=1e-9)


def test_no_correction_goes_beyond_the_crush_margin(plan: Plan, chain: Chain) -> None:
    safe = 35.0 / 1.3
    opening = 0.041 - safe / 1e5
    assert chain.grip_force(plan.safest, opening) == pytest.approx(safe)


def test_while_closing_the_friction_is_known(plan: Plan, chain: Chain) -> None:
    force, std = plan.expected(0.0107, 0.0408, eased=False)
    assert force == pytest.approx(chain.grip_force(0.0107, 0.0408))
    assert std == 0.0


def test_once_eased_the_friction_may_have_either_sign(plan: Plan, chain: Chain) -> None:
    force, std = plan.expected(0.0107, 0.0408, eased=True)
    closing = float(chain.grip_force(0.0107, 0.0408))
    opened = float(chain.grip_force(0.0107, 0.0408, Direction.EXTENDING))
    assert closing < force < opened
    assert force - closing == pytest.approx(opened - force)
    # Anything between the two is as likely: a uniform distribution.
    assert std == pytest.approx((opened - closing) / sqrt(12))


def test_tolerances_of_the_model_add_to_the_friction(
    chain: Chain, profiles: Profiles
) -> None:
    vague = replace(chain, tolerances={"muscle.diameter": 1e-4})
    plan = Plan(ordered(profiles["raw_egg"], Mode.FORCE), vague)
    _, std = plan.expected(0.0107, 0.0408, eased=False)
    _, eased = plan.expected(0.0107, 0.0408, eased=True)
    assert 0.0 < std < eased


def test_a_reduction_goes_through_the_friction(plan: Plan, chain: Chain) -> None:
    reduced = chain.current_for(30.0, PressedObject(0.041, 1e5)) - plan.reduction(30.0)
    opening = 0.041 - 35.0 / 1.3 / 1e5
    left = chain.grip_force(reduced, opening, Direction.EXTENDING)
    assert left == pytest.approx(35.0 / 1.3)


def spent(chain: Chain, limit: float) -> Chain:
    """The same with a supply that ends at a share of the regulator's 500 kPa."""
    return replace(chain, effects=(SupplySaturation(share=1.0, limit=limit),))


def test_the_line_of_the_model_is_aimed_with(chain: Chain, profiles: Profiles) -> None:
    # At 20 kPa beyond the line 0.64 mA less do: 16 mA on 500 kPa.
    plan = Plan(ordered(profiles["raw_egg"], Mode.FORCE), chain)
    high = replace(chain, effects=(ValveOffset(offset=20e3),))
    moved = Plan(ordered(profiles["raw_egg"], Mode.FORCE), high)
    for name in ("goal", "near", "safest", "closing_limit"):
        expected = getattr(plan, name) - 0.64e-3
        assert getattr(moved, name) == pytest.approx(expected), name


def test_free_jaws_are_not_driven_out_of_the_valve_s_span(
    chain: Chain, profiles: Profiles
) -> None:
    high = replace(chain, effects=(ValveOffset(offset=100e3),))
    melon = replace(profiles["apple"], diameter=0.085)
    assert Plan(ordered(melon, Mode.FORCE), high).near == 0.004


def test_what_no_current_gives_is_aimed_at_with_all_there_is(
    chain: Chain, profiles: Profiles
) -> None:
    # 12 N on 41 mm take 190 kPa; the supply gives 150 kPa.
    plan = Plan(ordered(profiles["raw_egg"], Mode.FORCE), spent(chain, 0.3))
    assert plan.goal == plan.safest == plan.closing_limit == 0.020


def test_jaws_that_never_get_near_are_not_hurried(
    chain: Chain, profiles: Profiles
) -> None:
    # Free jaws stand at 47 mm at 158 kPa; the supply gives 100 kPa.
    plan = Plan(ordered(profiles["raw_egg"], Mode.FORCE), spent(chain, 0.2))
    assert plan.near == 0.004


def test_a_force_beyond_the_model_s_valve_is_reduced_all_the_same(
    plan: Plan, chain: Chain, profiles: Profiles
) -> None:
    # Felt although the model's supply cannot give it: the line must do.
    doubted = Plan(ordered(profiles["raw_egg"], Mode.FORCE), spent(chain, 0.3))
    assert doubted.reduction(30.0) == pytest.approx(plan.reduction(30.0))
    assert doubted.current_per_newton(30.0) == pytest.approx(
        plan.current_per_newton(30.0)
    )
