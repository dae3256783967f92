"""Whatever is written, and wherever that is cut short: old or new, never half."""

import pytest

from tests.faults import power
from tests.faults.power import WRITES, Write


@pytest.mark.parametrize("write", WRITES, ids=lambda write: write.name)
def test_a_write_killed_at_any_call_leaves_old_or_new(write: Write) -> None:
    row = power.killed_between_calls(write)
    assert row.wrong == ()
    # The deaths lay on both sides of the moment that counts.
    assert set(row.came) == {power.OLD, power.NEW}


@pytest.mark.parametrize("write", WRITES, ids=lambda write: write.name)
def test_a_write_killed_at_any_byte_leaves_old_or_new(write: Write) -> None:
    row = power.killed_at_every_byte(write, 10 * write.stride)
    assert row.wrong == ()
    assert set(row.came) == {power.OLD, power.NEW}


def test_what_was_acknowledged_outlives_its_writer() -> None:
    assert power.killed_while_recording(kills=4).wrong == ()


def test_what_was_synced_outlives_the_rest_of_the_log() -> None:
    assert power.torn_log(cuts=10).wrong == ()
