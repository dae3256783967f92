from pathlib import Path

import pytest

from gripperd.errors import Refused
from gripperd.store.history import EventQuery, EventRecord, History

from .conftest import command, event


def entries(history: History, query: EventQuery) -> list[int | None]:
    return [record.entry for record in history.events(query)]


def test_a_key_finds_its_command_after_a_restart(history: History, path: Path) -> None:
    history.put([command(1), command(2)])
    history.close()
    again = History(path, "later")
    assert again.of_key("g0", "k1") == command(1)
    assert again.of_key("g1", "k1") is None
    assert again.set_aside is None
    again.close()


def test_a_later_record_keeps_the_key_and_the_life_it_was_given_to(
    history: History,
) -> None:
    history.put([command(1)])
    history.put([command(1, key=None, fingerprint="", life=9.0, final=True)])
    assert history.command("c1") == command(1, final=True)


def test_a_command_that_is_over_stays_over(history: History) -> None:
    history.put([command(1, final=True)])
    history.put([command(1, document="{}")])
    assert history.command("c1") == command(1, final=True)


def test_a_forgotten_command_frees_its_key(history: History) -> None:
    history.put([command(1)])
    history.forget("c1")
    assert history.of_key("g0", "k1") is None
    history.put([command(2, key="k1")])
    assert history.of_key("g0", "k1") == command(2, key="k1")


def test_a_key_never_stands_for_two_commands(history: History) -> None:
    history.put([command(1)])
    with pytest.raises(Refused, match="UNIQUE") as refused:
        history.put([command(2, key="k1")])
    assert refused.value.code == "not-recorded"
    assert history.command("c2") is None


def test_a_page_is_kept_whole_or_not_at_all(history: History) -> None:
    history.put([command(1)])
    with pytest.raises(Refused):
        history.put([command(3), command(2, key="k1")], [event(1)])
    assert history.command("c3") is None
    assert entries(history, EventQuery()) == []


def test_unfinished_commands_are_those_without_an_end(history: History) -> None:
    history.put([command(1), command(2, final=True), command(3, gripper="g1")])
    assert [record.id for record in history.unfinished("g0")] == ["c1"]


def test_the_newest_commands_come_first(history: History) -> None:
    history.put([command(2), command(3)])
    # The clock was set back before the last one, and the first is known better by now.
    history.put([command(1), command(2, final=True)])
    assert [record.id for record in history.newest("g0", 2)] == ["c1", "c3"]


def test_an_entry_that_is_told_twice_is_kept_once(history: History) -> None:
    first = history.put(told=[event(1), event(2)])
    again = history.put(told=[event(2), event(3)])
    assert [record.number for record in first] == [1, 2]
    assert [record.entry for record in again] == [3]
    assert entries(history, EventQuery()) == [3, 2, 1]


def test_numbers_are_not_given_again_after_the_newest_was_forgotten(
    history: History,
) -> None:
    history.put(told=[event(1), event(2)])
    history.forget_before(5000.0)
    (record,) = history.put(told=[event(3)])
    assert record.number == 3


def test_what_is_not_over_is_never_forgotten(history: History) -> None:
    history.put([command(1), command(2, final=True)])
    history.forget_before(5000.0)
    assert history.command("c1") == command(1)
    assert history.command("c2") is None


def test_the_last_entry_is_that_of_the_newest_life(history: History) -> None:
    assert history.last_entry("g0") == (0.0, 0)
    # A clock that was set back makes the newer life the smaller number.
    history.put(told=[event(7, life=5.0), event(2, life=3.0), event(9, gripper="g1")])
    assert history.last_entry("g0") == (3.0, 2)


@pytest.mark.parametrize(
    ("query", "expected"),
    [
        (EventQuery(), [4, 3, 2, 1]),
        (EventQuery(limit=2), [4, 3]),
        (EventQuery(before=3), [2, 1]),
        (EventQuery(after=2), [3, 4]),
        (EventQuery(after=1, limit=2), [2, 3]),
        (EventQuery(kinds=("command", "fault")), [4, 2]),
        (EventQuery(gripper="g1"), [3]),
        (EventQuery(command="c9"), [2]),
        (EventQuery(since=1002.0, until=1004.0), [3, 2]),
    ],
)
def test_events_are_found_by_what_is_asked(
    history: History, query: EventQuery, expected: list[int]
) -> None:
    history.put(
        told=[
            event(1),
            event(2, kind="command", command="c9"),
            event(3, gripper="g1"),
            event(4, kind="fault"),
        ]
    )
    assert entries(history, query) == expected


def test_an_event_says_what_it_said(history: History) -> None:
    told = EventRecord(at=1.25, kind="storage", document='{"text": "ü \\u0000"}')
    (kept,) = history.put(told=[told])
    assert history.events(EventQuery()) == [kept]
    assert kept.document == told.document
