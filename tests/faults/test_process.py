"""Ends of processes that tests/cli does not know of."""

from collections.abc import Iterator

import pytest

from tests.faults import process
from tests.faults.held import Held, held_egg
from tests.faults.process import CONTROL, SERVICE


@pytest.fixture(scope="module")
def held() -> Iterator[Held]:
    """A daemon with an egg, which outlives every test."""
    with held_egg() as held:
        yield held


def test_an_upgrade_of_both_adopts_what_is_held_and_says_so(held: Held) -> None:
    row = process.ended(held, "upgrade", process.told_to_end, SERVICE, CONTROL)
    assert row.wrong == ()


def test_control_without_memory_adopts_what_it_held_and_says_so(held: Held) -> None:
    row = process.out_of_memory(held, "no memory", process.no_memory)
    assert row.wrong == ()


def test_control_killed_for_its_memory_adopts_what_it_held(held: Held) -> None:
    with process.little_memory() as starve:
        if starve is None:
            pytest.skip("this machine lets nobody limit the memory of a process")
        assert process.out_of_memory(held, "killed", starve).wrong == ()
