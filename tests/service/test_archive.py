import asyncio
import sqlite3
import time
from contextlib import closing, suppress
from dataclasses import replace
from functools import partial
from pathlib import Path

import pytest

from gripperd.errors import Refused
from gripperd.service.archive import REST, Archive
from gripperd.service.event_documents import kept_event
from gripperd.store.history import CommandRecord, EventQuery, History
from tests.store.history.test_database import largest_file

pytestmark = pytest.mark.anyio

RECORD = CommandRecord(
    id="c1",
    gripper="g0",
    key="k1",
    fingerprint="f",
    life=1.0,
    created_at=1e9,
    final=False,
    document="{}",
)


async def kept(archive: Archive) -> CommandRecord | None:
    return await archive.do(lambda history: history.command("c1"))


async def test_trouble_is_told_while_it_lasts_and_then_no_more(tmp_path: Path) -> None:
    obstacle = tmp_path / "state"
    obstacle.write_text("in the way of a folder")
    archive = Archive(obstacle / "history.db", now=lambda: 1e9)
    with pytest.raises(Refused) as refused:
        await kept(archive)
    assert archive.trouble == str(refused.value)
    obstacle.unlink()
    await asyncio.sleep(REST)
    assert await kept(archive) is None
    assert not archive.trouble
    await archive.close()


async def test_a_full_disk_that_can_be_read_is_not_called_sound(tmp_path: Path) -> None:
    path = tmp_path / "history.db"
    archive = Archive(path, now=lambda: 1e9)
    for number in range(20):
        record = replace(RECORD, id=f"c{number}", key=f"k{number}")
        await archive.do(partial(History.put, kept=[record]))
    with closing(sqlite3.connect(path)) as other:
        # While somebody has it open, its log stays as long as it is.
        other.execute("SELECT count(*) FROM commands").fetchone()
        with largest_file(path.with_name("history.db-wal").stat().st_size):
            with pytest.raises(Refused):
                await archive.do(lambda history: history.forget("c1"))
            await asyncio.sleep(REST)
            assert await kept(archive) is not None
            assert archive.trouble
        assert await kept(archive) is not None
        assert not archive.trouble
    await archive.close()


async def test_a_disk_that_failed_is_left_alone_for_a_moment(tmp_path: Path) -> None:
    obstacle = tmp_path / "state"
    obstacle.write_text("in the way of a folder")
    archive = Archive(obstacle / "history.db", now=lambda: 1e9)
    began = time.monotonic()
    with pytest.raises(Refused):
        await kept(archive)
    obstacle.unlink()
    with suppress(Refused):
        await kept(archive)
    await archive.close()
    # A slow machine may come back when the moment is over.
    assert not obstacle.exists() or time.monotonic() - began > 0.5


async def test_a_damaged_history_is_replaced_and_the_new_one_says_so(
    tmp_path: Path,
) -> None:
    path = tmp_path / "history.db"
    path.write_bytes(b"rubbish" * 1000)
    archive = Archive(path, now=lambda: 1_700_000_000.0)
    (event,) = map(
        kept_event, await archive.do(lambda history: history.events(EventQuery()))
    )
    await archive.close()
    assert event.kind == "storage"
    assert "history.damaged-20231114T221320Z.db" in event.text
    assert "not a database" in event.text


async def test_what_was_answered_is_on_the_disk(tmp_path: Path) -> None:
    path = tmp_path / "history.db"
    archive = Archive(path, now=lambda: 1e9)
    await archive.do(lambda history: history.put([RECORD]))
    # Another reader sees only what was committed.
    with sqlite3.connect(path) as other:
        assert other.execute("SELECT id, key FROM commands").fetchall() == [
            ("c1", "k1")
        ]
    other.close()
    await archive.close()
