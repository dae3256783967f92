from itertools import count

import pytest

from gripperd.control.command import Command, Failure, Status
from gripperd.control.ledger import HISTORY, Key, Ledger
from gripperd.control.snapshot import Instant
from gripperd.errors import NotFound

NOW = Instant(100.0, 1e9)


@pytest.fixture
def ledger() -> Ledger:
    """Empty."""
    ids = count(1)
    return Ledger("g0", lambda: f"c{next(ids)}")


def accept(ledger: Ledger, key: Key | None = None) -> Command:
    return ledger.accept(None, 5.0, key, NOW)


def finish(ledger: Ledger) -> Command:
    command = ledger.next()
    assert command is not None
    return ledger.close(command, NOW.wall)


def test_commands_are_taken_in_order(ledger: Ledger) -> None:
    commands = [accept(ledger) for _ in range(3)]
    assert [ledger.next() for _ in range(4)] == [*commands, None]


def test_a_command_knows_both_clocks(ledger: Ledger) -> None:
    command = accept(ledger)
    assert (command.created_at, command.due) == (1e9, 105.0)
    assert (command.status, command.gripper) == (Status.QUEUED, "g0")


def test_the_newest_come_first(ledger: Ledger) -> None:
    for _ in range(5):
        accept(ledger)
    assert [command.id for command in ledger.newest(3)] == ["c5", "c4", "c3"]


@pytest.mark.parametrize(
    ("category", "status"),
    [
        ("cancelled", Status.CANCELLED),
        ("outcome", Status.FAILED),
        ("fault", Status.FAILED),
        ("precondition", Status.FAILED),
    ],
)
def test_the_category_of_a_failure_decides_the_status(
    ledger: Ledger, category: str, status: Status
) -> None:
    failure = Failure(category=category, code="x", message="x")
    command = ledger.close(accept(ledger), NOW.wall, failure=failure)
    assert command.status is status
    assert command.final
    assert ledger.next() is None


def test_old_commands_are_forgotten_with_their_keys(ledger: Ledger) -> None:
    key = Key("k", "release")
    first = accept(ledger, key)
    finish(ledger)
    for _ in range(HISTORY - 1):
        accept(ledger)
        finish(ledger)
    assert ledger.replay(key) == ledger.get(first.id)
    accept(ledger)
    assert ledger.replay(key) is None
    with pytest.raises(NotFound):
        ledger.get(first.id)


def test_a_command_that_waits_is_never_forgotten(ledger: Ledger) -> None:
    # A client that submits and cancels over and over, while one command waits.
    waiting = accept(ledger)
    for _ in range(HISTORY + 1):
        cancelled = Failure(category="cancelled", code="cancelled", message="")
        ledger.close(accept(ledger), NOW.wall, failure=cancelled)
    assert ledger.get(waiting.id) == waiting
    assert list(ledger.waiting()) == [waiting]
    assert ledger.overdue(NOW) == []
