"""Every command has one end, and every request one effect."""

from collections.abc import Iterator, Mapping

import httpx
import pytest

from gripperd.control.profile import Profile
from gripperd.model import Chain
from tests.faults import commands


@pytest.fixture(scope="module")
def http() -> Iterator[httpx.Client]:
    """A client of a daemon for all tests here."""
    with commands.daemon() as http:
        yield http


def test_a_command_cancelled_at_any_time_ends_once_and_leaves_it_ready(
    chain: Chain, profiles: Mapping[str, Profile]
) -> None:
    rows = list(commands.cancelled(chain, profiles["apple"], every=0.4))
    assert len(rows) == 8
    for row in rows:
        assert row.wrong == (), row.fault
        assert row.came["cancelled"]


def test_a_request_sent_many_times_at_once_has_one_effect(http: httpx.Client) -> None:
    assert commands.duplicated(http, rounds=1).wrong == ()


def test_of_clients_that_race_one_has_its_way_and_each_an_end(
    http: httpx.Client,
) -> None:
    assert commands.raced(http, rounds=1).wrong == ()


def test_a_lease_that_runs_out_ends_what_moves(http: httpx.Client) -> None:
    assert commands.lease_lost(http, rounds=1).wrong == ()
