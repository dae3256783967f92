import pytest
from pydantic import ValidationError

from gripperd.config.monitors import MonitorsSection
from gripperd.control.monitors.policy import POLICIES, Cause, Policy, Reaction


def policies(**given: object) -> dict[Cause, Policy]:
    return dict(MonitorsSection.model_validate(given).policies)


def test_what_is_left_out_stays_as_shipped() -> None:
    contacts = {Cause.NOT_ENABLED, Cause.ESTOPPED}
    assert policies() == {c: POLICIES[c] for c in Cause if c not in contacts}


def test_limits_come_with_their_units() -> None:
    found = policies(
        slip={"closing_mm": 0.2, "after_s": 0.1},
        force_drift={"drift_percent": 5.0},
        jaw_blocked={"unmet_N": 20.0},
    )
    assert found[Cause.SLIP].limit == pytest.approx(0.2e-3)
    assert found[Cause.SLIP].after == 0.1
    assert found[Cause.FORCE_DRIFT].limit == pytest.approx(0.05)
    assert found[Cause.JAW_BLOCKED].limit == 20.0
    assert found[Cause.BURST] == POLICIES[Cause.BURST]


def test_a_reaction_that_moves_the_jaws_is_latched() -> None:
    found = policies(part_lost={"reaction": "controlled_release"})
    assert found[Cause.PART_LOST].reaction is Reaction.CONTROLLED_RELEASE
    assert found[Cause.PART_LOST].latched


def test_a_latch_can_be_taken_away_where_nothing_moves() -> None:
    found = policies(valve_not_following={"latch": False})
    assert not found[Cause.VALVE_NOT_FOLLOWING].latched


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"slip": {"closing_mm": 0.0}}, "slip.closing_mm"),
        ({"slip": {"closing_mm": 21.0}}, "slip.closing_mm"),
        ({"slip": {"closing": 0.2}}, "slip.closing"),
        ({"force_drift": {"drift_percent": float("nan")}}, "force_drift.drift_percent"),
        ({"burst": {"after_s": -1.0}}, "burst.after_s"),
        ({"leak": {"reaction": "explode"}}, "leak.reaction"),
        ({"fire": {}}, "fire"),
        (
            {"slip": {"reaction": "vent", "latch": False}},
            "slip: latch: false goes with",
        ),
        ({"jaw_blocked": {"latch": False}}, "jaw_blocked: latch: false goes with"),
    ],
)
def test_what_cannot_be_meant_is_refused_with_its_key(
    given: dict[str, object], said: str
) -> None:
    with pytest.raises(ValidationError) as refused:
        MonitorsSection.model_validate(given)
    (error,) = refused.value.errors()
    place = ".".join(str(part) for part in error["loc"])
    assert said in f"{place}: {error['msg']}"
