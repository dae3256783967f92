"""Faults of the rig that are an outcome, not an alarm; the rest is in tests/control."""

from collections.abc import Mapping

import pytest

from gripperd.bench.sensors import Channel
from gripperd.control.profile import Profile
from gripperd.model import Chain
from tests.control.monitors.watched import holding
from tests.faults import rig


def test_an_object_of_another_size_is_held_lightly_and_told(
    chain: Chain, profiles: Mapping[str, Profile]
) -> None:
    row = rig.other_sizes(chain, [profiles["apple"], profiles["raw_egg"]])
    assert row.wrong == ()


@pytest.mark.parametrize("channel", Channel)
def test_a_sensor_full_of_spikes_is_told_and_nothing_is_let_go(
    chain: Chain, profiles: Mapping[str, Profile], channel: Channel
) -> None:
    row = rig.spiking([holding(chain, profiles["raw_egg"])], channel)
    assert row.wrong == ()
    assert row.kept


@pytest.mark.parametrize("channel", Channel)
def test_one_wild_sample_is_shown_to_nobody_and_changes_nothing(
    chain: Chain, profiles: Mapping[str, Profile], channel: Channel
) -> None:
    row = rig.single([holding(chain, profiles["raw_egg"])], channel, tries=2)
    assert row.wrong == ()
    assert row.came == {"not shown": 2}
