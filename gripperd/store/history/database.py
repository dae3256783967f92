"""The database file: opened, checked, brought up to date, or set aside.

SQLite with a write-ahead log and a full sync at each commit: what was committed
survives a power cut [1]_, and a file that was cut off reads as before the commit.

References
----------
.. [1] https://www.sqlite.org/pragma.html#pragma_synchronous
"""

import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from alembic import command
from alembic.config import Config
from alembic.util import CommandError
from sqlalchemy import Connection, Engine, create_engine, event
from sqlalchemy.exc import DBAPIError, SQLAlchemyError

from gripperd.errors import Refused

MIGRATIONS = Path(__file__).parent / "migrations"
BUSY = 2000
"""How long another program may lock the file. [ms]"""
DAMAGED = frozenset({sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_NOTADB})
"""What SQLite says of a file that it did not write like this."""
NOT_RECORDED = "not-recorded"
"""Code of every refusal by the disk."""
WITHOUT = (
    "holding goes on, and a stop needs no history",
    "a command without Idempotency-Key is carried out unrecorded",
)
"""What still works."""
PARTS = ("", "-wal", "-shm")
"""A database is these files together."""


@dataclass(frozen=True, slots=True)
class SetAside:
    """A damaged database and where it is now."""

    path: Path
    reason: str


def open_database(path: Path, moment: str) -> tuple[Engine, SetAside | None]:
    """Open the database, make it if there is none, replace it if it is damaged.

    Parameters
    ----------
    path
        The file.
    moment
        Goes into the name of a damaged file that is set aside.

    Raises
    ------
    Refused
        Disk, rights or another program are in the way; or the file is of a newer
        gripperd.
    """
    with telling(path):
        path.parent.mkdir(parents=True, exist_ok=True)
        reason = _damage(path) if path.exists() else None
        aside = None if reason is None else SetAside(_set_aside(path, moment), reason)
        engine = _engine(path)
        try:
            _migrate(engine)
        except BaseException:
            engine.dispose()
            raise
        return engine, aside


@contextmanager
def telling(path: Path) -> Iterator[None]:
    """Let what fails on the disk inside be told in our words."""
    try:
        yield
    except DBAPIError as error:
        raise _unusable(path, str(error.orig)) from error
    except (SQLAlchemyError, CommandError) as error:
        raise _unusable(path, str(error)) from error
    except OSError as error:
        raise _unusable(path, error.strerror or str(error)) from error


def _unusable(path: Path, reason: str) -> Refused:
    message = f"{path}: the history cannot be kept: {reason}"
    return Refused(message, code=NOT_RECORDED, hints=WITHOUT)


def _engine(path: Path) -> Engine:
    engine = create_engine(
        f"sqlite+pysqlite:///{path}", connect_args={"timeout": BUSY / 1000}
    )

    @event.listens_for(engine, "connect")
    def settle(connection: sqlite3.Connection, _: object) -> None:
        # Otherwise the driver begins transactions, and not where we want them.
        connection.isolation_level = None
        connection.execute("PRAGMA journal_mode = WAL")
        connection.execute("PRAGMA synchronous = FULL")

    @event.listens_for(engine, "begin")
    def begin(connection: Connection) -> None:
        connection.exec_driver_sql("BEGIN IMMEDIATE")

    return engine


def _migrate(engine: Engine) -> None:
    config = Config()
    config.set_main_option("script_location", str(MIGRATIONS).replace("%", "%%"))
    with engine.begin() as connection:
        config.attributes["connection"] = connection
        command.upgrade(config, "head")


def _damage(path: Path) -> str | None:
    """What is wrong with the file itself, None if it is sound.

    Raises
    ------
    sqlite3.Error
        It cannot be told now.
    """
    connection = sqlite3.connect(path, timeout=BUSY / 1000)
    try:
        (found,) = connection.execute("PRAGMA quick_check(1)").fetchone()
    except sqlite3.DatabaseError as error:
        # The low byte is the kind, the others say more of it.
        if error.sqlite_errorcode & 0xFF in DAMAGED:
            return str(error)
        raise _unusable(path, str(error)) from error
    finally:
        connection.close()
    return None if found == "ok" else str(found)


def _set_aside(path: Path, moment: str) -> Path:
    aside = path.with_name(f"{path.stem}.damaged-{moment}{path.suffix}")
    for part in PARTS:
        old = path.with_name(path.name + part)
        if old.exists():
            old.replace(aside.with_name(aside.name + part))
    return aside
