"""What a damaged, cut-off, full or locked file does: old or new, never half."""

import resource
import shutil
import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from random import Random

import pytest
from alembic.autogenerate import compare_metadata
from alembic.migration import MigrationContext
from sqlalchemy import create_engine

from gripperd.errors import Refused
from gripperd.store.history import EventQuery, History
from gripperd.store.history.tables import metadata

from .conftest import command, event


def fill(history: History, count: int, first: int = 0) -> None:
    for number in range(first, first + count):
        history.put([command(number)], [event(number)])


@contextmanager
def largest_file(size: int) -> Iterator[None]:
    """Let no file of this process grow beyond a size: a disk that is full."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


def test_the_migrations_lead_to_the_tables(history: History, path: Path) -> None:
    engine = create_engine(f"sqlite:///{path}")
    with engine.connect() as connection:
        context = MigrationContext.configure(connection)
        assert compare_metadata(context, metadata) == []
    engine.dispose()


def test_every_commit_is_synced(history: History) -> None:
    with history._engine.connect() as connection:
        assert connection.exec_driver_sql("PRAGMA synchronous").scalar() == 2
        assert connection.exec_driver_sql("PRAGMA journal_mode").scalar() == "wal"


def test_a_log_cut_off_at_any_byte_reads_as_of_an_earlier_commit(
    history: History, path: Path, tmp_path: Path
) -> None:
    fill(history, 8)
    log = path.with_name("history.db-wal")
    size = log.stat().st_size
    random = Random(1)
    seen = set()
    for cut in [0, size, *(random.randrange(size) for _ in range(40))]:
        copy = tmp_path / f"cut{cut}" / "history.db"
        copy.parent.mkdir(exist_ok=True)
        shutil.copy(path, copy)
        copy.with_name("history.db-wal").write_bytes(log.read_bytes()[:cut])
        torn = History(copy, "torn")
        kept = [record.entry for record in torn.events(EventQuery(after=0))]
        commands = [record.id for record in torn.newest("g0", 100)]
        torn.close()
        assert torn.set_aside is None
        # Commits are whole: each had one command and one event.
        assert kept == list(range(len(kept)))
        assert commands == [f"c{number}" for number in reversed(kept)]
        seen.add(len(kept))
    # The cut was before, between and behind the commits.
    assert {0, 8} <= seen
    assert len(seen) > 4


def test_a_file_cut_off_at_any_byte_is_whole_or_set_aside(
    history: History, path: Path, tmp_path: Path
) -> None:
    fill(history, 40)
    history.close()
    content = path.read_bytes()
    random = Random(2)
    cuts = (random.randrange(4096, len(content)) for _ in range(30))
    for cut in [0, 600, 4096, *cuts]:
        copy = tmp_path / f"cut{cut}" / "history.db"
        copy.parent.mkdir(exist_ok=True)
        copy.write_bytes(content[:cut])
        found = History(copy, "cut")
        assert (found.set_aside is None) == (cut == 0)
        assert found.newest("g0", 1) == []
        found.put([command(1)])
        found.close()


def test_a_damaged_file_is_set_aside_and_not_lost(history: History, path: Path) -> None:
    fill(history, 3)
    history.close()
    path.write_bytes(b"rubbish" * 1000)
    again = History(path, "20260101T000000Z")
    again.close()
    assert again.set_aside is not None
    aside = path.with_name("history.damaged-20260101T000000Z.db")
    assert again.set_aside.path == aside
    assert "not a database" in again.set_aside.reason
    assert aside.read_bytes() == b"rubbish" * 1000


def test_a_page_that_was_overwritten_is_found_at_the_start(
    history: History, path: Path
) -> None:
    fill(history, 40)
    history.close()
    content = bytearray(path.read_bytes())
    content[4096 * 3 : 4096 * 4] = Random(3).randbytes(4096)
    path.write_bytes(content)
    again = History(path, "later")
    again.close()
    assert again.set_aside is not None


def test_a_flipped_bit_in_a_record_is_found_by_its_digest(
    history: History, path: Path
) -> None:
    fill(history, 3)
    history.close()
    content = path.read_bytes()
    assert content.count(b'"id": "c1"') == 1
    path.write_bytes(content.replace(b'"id": "c1"', b'"id": "c3"'))
    again = History(path, "later")
    assert again.set_aside is None
    assert again.command("c1") is None
    assert again.command("c2") == command(2)
    assert again.damaged == {"CommandRecord c1"}
    again.close()


def test_a_full_disk_refuses_and_loses_nothing(history: History, path: Path) -> None:
    fill(history, 20)
    size = path.with_name("history.db-wal").stat().st_size
    with largest_file(size + 5000), pytest.raises(Refused) as refused:
        fill(history, 100, first=20)
    assert refused.value.code == "not-recorded"
    assert str(path) in str(refused.value)
    kept = {record.id for record in history.newest("g0", 1000)}
    assert {f"c{number}" for number in range(20)} <= kept
    fill(history, 5, first=200)
    assert history.command("c204") == command(204)


def test_a_full_disk_can_be_read_and_is_not_taken_for_a_sound_one(
    history: History, path: Path
) -> None:
    fill(history, 3)
    size = path.with_name("history.db-wal").stat().st_size
    with largest_file(size):
        assert history.command("c1") == command(1)
        with pytest.raises(Refused, match="history cannot be kept"):
            history.prove()
    history.prove()
    assert [record.id for record in history.newest("g0", 9)] == ["c2", "c1", "c0"]


def test_a_file_that_another_program_locks_is_told(
    path: Path, history: History
) -> None:
    other = sqlite3.connect(path, isolation_level=None)
    other.execute("BEGIN IMMEDIATE")
    with pytest.raises(Refused, match="locked"):
        history.put([command(1)])
    other.execute("ROLLBACK")
    other.close()
    history.put([command(1)])


def test_a_place_that_is_no_folder_is_told(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(Refused, match="history cannot be kept"):
        History(tmp_path / "file" / "history.db", "now")


def test_a_history_of_a_newer_program_is_left_alone(
    history: History, path: Path
) -> None:
    fill(history, 1)
    history.close()
    newer = sqlite3.connect(path)
    newer.execute("UPDATE alembic_version SET version_num = 'tomorrow'")
    newer.commit()
    newer.close()
    with pytest.raises(Refused, match="tomorrow"):
        History(path, "now")
    assert [file.name for file in path.parent.glob("*damaged*")] == []
