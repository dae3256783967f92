"""Made-up profiles are on the careful side."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gripperd.config import parse_profile, profile_document, reference_chain
from gripperd.control.command import GraspOrder
from gripperd.control.evaluation import evaluate
from gripperd.control.grasp import TRIP_MARGIN
from gripperd.control.profile import Mode
from gripperd.errors import DomainError
from gripperd.service.assumption import assumed_profile

CHAIN = reference_chain()


@given(diameter=st.floats(5e-3, 85e-3), force=st.floats(0.1, 150.0))
def test_the_force_asked_for_is_never_harmful_by_assumption(
    diameter: float, force: float
) -> None:
    profile = assumed_profile(diameter, current=None, force=force, chain=CHAIN)
    order = GraspOrder(profile=profile, mode=Mode.FORCE, target=force, model="m")
    reasons = evaluate(order, CHAIN).reasons
    assert not any("damaged" in reason for reason in reasons)
    # The grasp is cut short well above the target, yet within half as much again.
    assert force < profile.damage_force / TRIP_MARGIN < 1.5 * force


@given(diameter=st.floats(5e-3, 85e-3), current=st.floats(4e-3, 20e-3))
def test_a_current_may_give_what_the_model_is_unsure_of(
    diameter: float, current: float
) -> None:
    profile = assumed_profile(diameter, current=current, force=None, chain=CHAIN)
    order = GraspOrder(profile=profile, mode=Mode.CURRENT, target=current, model="m")
    found = evaluate(order, CHAIN)
    sure = found.prediction.grip_force + 2 * found.prediction.grip_std
    assert profile.damage_force == pytest.approx(1.5 * sure, rel=1e-9)


def test_it_is_a_profile_like_any_other_but_for_its_version() -> None:
    profile = assumed_profile(58e-3, current=None, force=12.0, chain=CHAIN)
    document = profile_document(profile)
    assert document["version"] == 0
    again = parse_profile(document | {"version": 1})
    assert again.damage_force == pytest.approx(18.0)
    assert again.mass == pytest.approx(0.10216, rel=1e-3)


def test_an_object_wider_than_the_jaws_is_refused() -> None:
    with pytest.raises(DomainError, match="does not fit"):
        assumed_profile(90e-3, current=None, force=12.0, chain=CHAIN)
