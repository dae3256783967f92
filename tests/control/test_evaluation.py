from collections.abc import Mapping
from dataclasses import replace

import pytest

from gripperd.control.evaluation import check, evaluate
from gripperd.control.profile import Mode, Profile
from gripperd.effects.supply_saturation import SupplySaturation
from gripperd.effects.valve_gain import ValveGain
from gripperd.errors import Refused
from gripperd.model import Chain

from .stage import ordered

Profiles = Mapping[str, Profile]


@pytest.mark.parametrize(
    ("name", "rigid"),
    [("apple", 47.6), ("peach", 39.8), ("raw_egg", 22.5), ("grape", 5.6)],
)
def test_10_7_milliamperes_hold_each_object_of_the_paper(
    chain: Chain, profiles: Profiles, name: str, rigid: float
) -> None:
    firm = replace(profiles[name], stiffness=1e9)
    evaluation = check(ordered(firm, Mode.CURRENT, 0.0107), chain)
    force = evaluation.prediction.grip_force
    assert force == pytest.approx(rigid, abs=0.05)
    assert evaluation.slip_margin == pytest.approx(force / firm.slip_force)
    assert evaluation.crush_margin == pytest.approx(firm.damage_force / force)


@pytest.mark.parametrize("name", ["apple", "peach", "raw_egg", "grape"])
def test_a_force_is_what_its_current_gives(
    chain: Chain, profiles: Profiles, name: str
) -> None:
    profile = profiles[name]
    aimed = check(ordered(profile, Mode.FORCE), chain)
    assert aimed.prediction.grip_force == pytest.approx(profile.force)
    again = check(ordered(profile, Mode.CURRENT, aimed.current), chain)
    assert again.prediction.grip_force == pytest.approx(profile.force)


def test_too_hard_a_grasp_is_refused_with_its_numbers(
    chain: Chain, profiles: Profiles
) -> None:
    with pytest.raises(Refused) as refused:
        check(ordered(profiles["raw_egg"], Mode.FORCE, 30.0), chain)
    assert refused.value.code == "infeasible"
    assert refused.value.hints
    assert str(refused.value) == (
        "30.00 N per jaw is over 26.92 N: raw_egg is damaged at 35 N, and its crush"
        " margin is 1.3"
    )


def test_too_light_a_grasp_is_refused_with_its_numbers(
    chain: Chain, profiles: Profiles
) -> None:
    with pytest.raises(Refused) as refused:
        check(ordered(profiles["apple"], Mode.FORCE, 2.0), chain)
    assert str(refused.value) == (
        "2.00 N per jaw is under 4.00 N: apple slips at 2.67 N, and its slip margin"
        " is 1.5"
    )


def test_a_current_the_valve_cannot_take_is_refused(
    chain: Chain, profiles: Profiles
) -> None:
    steel = replace(profiles["apple"], damage_force=1e6)
    with pytest.raises(Refused, match=r"it takes 37\.05 mA, and the valve takes 4"):
        check(ordered(steel, Mode.FORCE, 500.0), chain)
    with pytest.raises(Refused, match=r"it takes 3\.00 mA"):
        check(ordered(steel, Mode.CURRENT, 0.003), chain)


def test_every_reason_is_told_at_once(chain: Chain, profiles: Profiles) -> None:
    evaluation = evaluate(ordered(profiles["apple"], Mode.FORCE, 500.0), chain)
    assert not evaluation.feasible
    assert len(evaluation.reasons) == 2


def test_what_does_not_fit_is_refused_with_both_sizes(
    chain: Chain, profiles: Profiles
) -> None:
    melon = replace(profiles["apple"], diameter=0.0851)
    with pytest.raises(Refused, match=r"85\.1 mm does not fit.* open 85 mm") as refused:
        check(ordered(melon, Mode.FORCE), chain)
    assert refused.value.code == "infeasible"


def test_exactly_at_a_margin_is_still_feasible(
    chain: Chain, profiles: Profiles
) -> None:
    for profile in profiles.values():
        hardest = profile.damage_force / profile.crush_margin
        lightest = profile.slip_force * profile.slip_margin
        for target in (hardest, lightest):
            assert evaluate(ordered(profile, Mode.FORCE, target), chain).reasons == ()


@pytest.mark.parametrize("name", ["apple", "peach", "raw_egg", "grape"])
def test_a_thousandth_past_a_margin_is_not_feasible(
    chain: Chain, profiles: Profiles, name: str
) -> None:
    profile = profiles[name]
    for target in (
        profile.damage_force / profile.crush_margin * 1.001,
        profile.slip_force * profile.slip_margin * 0.999,
    ):
        assert len(evaluate(ordered(profile, Mode.FORCE, target), chain).reasons) == 1


def test_the_ends_of_the_valve_are_feasible(chain: Chain, profiles: Profiles) -> None:
    sturdy = replace(profiles["apple"], damage_force=1e6, mass=1e-9)
    assert evaluate(ordered(sturdy, Mode.CURRENT, 0.020), chain).feasible
    # At 4 mA there is no pressure, so no force either: only that is refused.
    (reason,) = evaluate(ordered(sturdy, Mode.CURRENT, 0.004), chain).reasons
    assert reason.startswith("0.00 N per jaw is under")


def test_what_the_supply_cannot_give_is_refused_with_what_it_gives(
    chain: Chain, profiles: Profiles
) -> None:
    spent = replace(chain, effects=(SupplySaturation(share=1.0, limit=0.3),))
    evaluation = evaluate(ordered(profiles["raw_egg"], Mode.FORCE), spent)
    assert not evaluation.feasible
    assert evaluation.current == 0.020
    assert evaluation.prediction.pressure == pytest.approx(150e3)
    (reason,) = evaluation.reasons
    assert reason.startswith("12.00 N per jaw cannot be had: the valve does not reach")
    assert "with supply_saturation" in reason
    with pytest.raises(Refused, match="cannot be had") as refused:
        check(ordered(profiles["raw_egg"], Mode.FORCE), spent)
    assert refused.value.code == "infeasible"


def test_the_top_of_the_valve_is_told_as_the_model_has_it(
    chain: Chain, profiles: Profiles
) -> None:
    steep = replace(chain, effects=(ValveGain(error=0.1),))
    steel = replace(profiles["apple"], damage_force=1e6)
    with pytest.raises(Refused, match=r"\(up to 550 kPa\)"):
        check(ordered(steel, Mode.FORCE, 500.0), steep)
