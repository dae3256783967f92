from collections.abc import Iterator
from pathlib import Path

import pytest

from gripperd.store.history import CommandRecord, EventRecord, History


def command(number: int, **other: object) -> CommandRecord:
    values: dict[str, object] = {
        "id": f"c{number}",
        "gripper": "g0",
        "key": f"k{number}",
        "fingerprint": f"f{number}",
        "life": 1.5,
        "created_at": 1000.0 + number,
        "final": False,
        "document": f'{{"id": "c{number}"}}',
    }
    return CommandRecord(**(values | other))  # type: ignore[arg-type]


def event(entry: int, **other: object) -> EventRecord:
    values: dict[str, object] = {
        "at": 1000.0 + entry,
        "kind": "state",
        "gripper": "g0",
        "life": 1.5,
        "entry": entry,
        "document": f'{{"text": "entry {entry}"}}',
    }
    return EventRecord(**(values | other))  # type: ignore[arg-type]


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """Where the database is."""
    return tmp_path / "history.db"


@pytest.fixture
def history(path: Path) -> Iterator[History]:
    """Empty."""
    history = History(path, "now")
    yield history
    history.close()
