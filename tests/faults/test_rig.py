"""Faults of the rig that are an outcome, not an alarm; the rest is in tests/control."""

from collections.abc import Mapping

from gripperd.control.profile import Profile
from gripperd.model import Chain
from tests.faults import rig


def test_an_object_of_another_size_is_held_lightly_and_told(
    chain: Chain, profiles: Mapping[str, Profile]
) -> None:
    row = rig.other_sizes(chain, [profiles["apple"], profiles["raw_egg"]])
    assert row.wrong == ()
