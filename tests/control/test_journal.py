from dataclasses import replace

import pytest

from gripperd.control.command import GraspOrder
from gripperd.control.journal import PAGE, Entry, Happening, Journal
from gripperd.control.states import Grip, Machine

from .stage import Stage, real


def told(stage: Stage, kind: Happening) -> list[Entry]:
    return [each for each in stage.gripper.ledger.journal.since(0) if each.kind is kind]


def look(stage: Stage) -> None:
    stage.gripper.ledger.journal.look(stage.state, stage.instant.wall)


def test_a_command_is_told_when_its_status_changes_and_only_then(
    ready: Stage, apple: GraspOrder
) -> None:
    ready.rig.plant.place(real(apple.profile))
    command = ready.complete(apple)
    entries = told(ready, Happening.COMMAND)
    statuses = [each.command.status for each in entries if each.command]
    assert statuses == ["queued", "running", "succeeded"]
    assert entries[-1].command == command
    times = [each.at for each in entries]
    assert times == [command.created_at, command.started_at, command.completed_at]


def test_a_failure_is_told_with_its_reason(ready: Stage, apple: GraspOrder) -> None:
    ready.submit(apple)
    ready.stop()
    (*_, last) = told(ready, Happening.COMMAND)
    assert "cancelled: stopped" in last.text


def test_states_are_told_once_each(stage: Stage) -> None:
    for _ in range(20):
        look(stage)
        stage.tick()
    found = [(each.machine, each.grip) for each in told(stage, Happening.STATE)]
    assert found == [
        (Machine.OFFLINE, Grip.UNKNOWN),
        (Machine.ATTACHING, Grip.UNKNOWN),
        (Machine.READY, Grip.RELEASED),
    ]


def test_what_was_found_after_a_restart_is_told_with_its_current(stage: Stage) -> None:
    stage.write(0.0107)
    for _ in range(20):
        stage.tick()
        look(stage)
    (adoption,) = told(stage, Happening.ADOPTION)
    assert adoption.text == "adopted 10.70 mA as found"


def test_a_current_that_somebody_else_set_is_told_with_both(ready: Stage) -> None:
    look(ready)
    ready.write(0.006)
    for _ in range(5):
        ready.tick()
        look(ready)
    (_, foreign) = told(ready, Happening.ADOPTION)
    assert "adopted 6.00 mA, not 0.00 mA: somebody else" in foreign.text


def test_numbers_have_no_gaps_and_old_entries_give_way() -> None:
    journal = Journal(length=5)
    assert (journal.oldest, journal.newest) == (1, 0)
    for at in range(8):
        journal.note(Happening.LEASE, f"note {at}", float(at))
    assert (journal.oldest, journal.newest) == (4, 8)
    assert [each.number for each in journal.since(0)] == [4, 5, 6, 7, 8]
    assert [each.number for each in journal.since(6)] == [7, 8]
    assert journal.since(8) == ()


def test_a_page_is_never_too_long_for_a_message() -> None:
    journal = Journal()
    for at in range(PAGE + 7):
        journal.note(Happening.LEASE, "", float(at))
    assert len(journal.since(0)) == PAGE
    assert len(journal.since(PAGE)) == 7


@pytest.mark.parametrize("change", [{"machine": Machine.FAULT}, {"grip": Grip.MOVING}])
def test_either_state_alone_is_news(ready: Stage, change: dict[str, object]) -> None:
    journal = Journal()
    journal.look(ready.state, 1.0)
    before = journal.newest
    journal.look(replace(ready.state, **change), 2.0)  # type: ignore[arg-type]
    assert journal.newest == before + 1
