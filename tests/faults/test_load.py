"""Whatever is done to the service, the egg stays held and control the same process."""

from collections.abc import Iterator

import pytest

from tests.faults import load
from tests.faults.held import Held, held_egg
from tests.faults.row import Row


@pytest.fixture(scope="module")
def held() -> Iterator[Held]:
    """A daemon with an egg, which outlives every test."""
    with held_egg() as held:
        yield held


def wrong(rows: list[Row]) -> list[str]:
    return [each for row in rows for each in row.wrong]


def test_a_stalled_service_goes_on_where_it_was(held: Held) -> None:
    assert wrong(load.stalled(held)) == []


def test_a_flood_is_answered_or_refused_with_a_reason(held: Held) -> None:
    assert wrong(load.flooded(held, seconds=1.0)) == []


def test_mute_connections_give_way_to_a_stop(held: Held) -> None:
    assert wrong(load.crowded(held, mute=2000)) == []


def test_a_body_without_end_is_refused_at_its_beginning(held: Held) -> None:
    assert wrong(load.oversized(held)) == []


def test_a_reader_that_never_reads_is_dropped(held: Held) -> None:
    assert wrong(load.unread(held)) == []
