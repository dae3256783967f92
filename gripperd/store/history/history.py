"""Commands and events in the database; for one thread."""

import operator
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict, replace
from pathlib import Path
from typing import TypeAlias, TypeVar

from sqlalchemy import (
    ColumnElement,
    Connection,
    Select,
    delete,
    func,
    literal_column,
    select,
)
from sqlalchemy.dialects.sqlite import insert

from gripperd.store.history.database import SetAside, open_database, telling
from gripperd.store.history.records import CommandRecord, EventQuery, EventRecord
from gripperd.store.history.tables import commands, events

Wanted: TypeAlias = Select[*tuple[object, ...]]
T = TypeVar("T", CommandRecord, EventRecord)
KEPT: ColumnElement[int] = literal_column("rowid")
"""SQLite counts rows by itself. A clock can be set back; this never is."""


class History:
    """Everything that is kept about commands and events.

    Every method raises :class:`Refused` when the disk does not do it; nothing was
    changed then. A record whose digest does not fit is left out and counted.

    Parameters
    ----------
    path
        The database file.
    moment
        Goes into the name of a damaged file that is set aside.
    """

    def __init__(self, path: Path, moment: str) -> None:
        self._path = path
        self.set_aside: SetAside | None
        """The damaged file that stood there before."""
        self.damaged: set[str] = set()
        """Records that were found damaged: their id or number."""
        self._engine, self.set_aside = open_database(path, moment)

    def close(self) -> None:
        """Let go of the file."""
        self._engine.dispose()

    def put(
        self, kept: Iterable[CommandRecord] = (), told: Iterable[EventRecord] = ()
    ) -> Sequence[EventRecord]:
        """Keep commands and events, all of them or none; durable on return.

        A command replaces what was known of it, unless it is over and the new record
        says that it is not; its key, its fingerprint and the control process it was
        given to stay. An event that is there already is left out.

        Returns
        -------
        The events that are new, with their numbers.
        """
        with self._writing() as connection:
            for record in kept:
                _put_command(connection, record)
            numbered = [_put_event(connection, record) for record in told]
        return [record for record in numbered if record is not None]

    def prove(self) -> None:
        """Write something that means nothing: the disk takes what is written."""
        with self._writing() as connection:
            connection.exec_driver_sql("PRAGMA user_version = 1")

    def forget(self, command: str) -> None:
        """Drop a command that was refused: its key is free again."""
        with self._writing() as connection:
            connection.execute(delete(commands).where(commands.c.id == command))

    def forget_before(self, moment: float) -> None:
        """Drop commands that are over, and events, from before a time. [s]."""
        with self._writing() as connection:
            old = commands.c.final & (commands.c.created_at < moment)
            connection.execute(delete(commands).where(old))
            connection.execute(delete(events).where(events.c.at < moment))

    def command(self, command: str) -> CommandRecord | None:
        """One command, if it is known and undamaged."""
        return self._one(select(commands).where(commands.c.id == command))

    def of_key(self, gripper: str, key: str) -> CommandRecord | None:
        """The command that a client's key stands for."""
        wanted = (commands.c.gripper == gripper) & (commands.c.key == key)
        return self._one(select(commands).where(wanted))

    def newest(self, gripper: str, count: int) -> Sequence[CommandRecord]:
        """The last commands in the order in which they were kept, newest first."""
        wanted = select(commands).where(commands.c.gripper == gripper)
        return self._commands(wanted.order_by(KEPT.desc()).limit(count))

    def unfinished(self, gripper: str) -> Sequence[CommandRecord]:
        """Commands whose end is not known, oldest first."""
        wanted = (commands.c.gripper == gripper) & commands.c.final.is_(False)
        return self._commands(select(commands).where(wanted).order_by(KEPT))

    def events(self, query: EventQuery) -> Sequence[EventRecord]:
        """Events; the newest first, unless those after a number are asked for."""
        return self._sound(EventRecord, _chosen(query), "number")

    def last_entry(self, gripper: str) -> tuple[float, int]:
        """Life and number of the last entry of a journal that is kept; 0, 0 if none."""
        wanted = (events.c.gripper == gripper) & events.c.entry.is_not(None)
        newest = select(func.max(events.c.number)).where(wanted).scalar_subquery()
        found = select(events.c.life, events.c.entry).where(events.c.number == newest)
        with telling(self._path), self._engine.connect() as connection:
            row = connection.execute(found).one_or_none()
        return (0.0, 0) if row is None else (row.life, row.entry)

    def _one(self, wanted: Wanted) -> CommandRecord | None:
        return next(iter(self._commands(wanted)), None)

    def _commands(self, wanted: Wanted) -> Sequence[CommandRecord]:
        return self._sound(CommandRecord, wanted, "id")

    def _sound(self, kind: type[T], wanted: Wanted, name: str) -> Sequence[T]:
        """Records that are as they were written."""
        with telling(self._path), self._engine.connect() as connection:
            rows = connection.execute(wanted).mappings().all()
        found = []
        for row in rows:
            values = dict(row)
            digest = values.pop("digest")
            record = kind(**values)
            if record.digest == digest:
                found.append(record)
            else:
                self.damaged.add(f"{kind.__name__} {values[name]}")
        return found

    @contextmanager
    def _writing(self) -> Iterator[Connection]:
        with telling(self._path), self._engine.begin() as connection:
            yield connection


def _put_command(connection: Connection, record: CommandRecord) -> None:
    known = connection.execute(
        select(commands).where(commands.c.id == record.id)
    ).one_or_none()
    if known is not None:
        if known.final and not record.final:
            return
        record = replace(
            record, key=known.key, fingerprint=known.fingerprint, life=known.life
        )
    row = {**asdict(record), "digest": record.digest}
    connection.execute(
        insert(commands)
        .values(row)
        .on_conflict_do_update(index_elements=[commands.c.id], set_=row)
    )


def _put_event(connection: Connection, record: EventRecord) -> EventRecord | None:
    row = {**asdict(record), "digest": record.digest}
    del row["number"]
    number = connection.execute(
        insert(events).values(row).on_conflict_do_nothing().returning(events.c.number)
    ).scalar()
    return None if number is None else replace(record, number=number)


def _chosen(query: EventQuery) -> Wanted:
    column = events.c
    wanted = select(events).limit(query.limit)
    if query.kinds:
        wanted = wanted.where(column.kind.in_(query.kinds))
    for compared, asked, operation in (
        (column.gripper, query.gripper, operator.eq),
        (column.command, query.command, operator.eq),
        (column.at, query.since, operator.ge),
        (column.at, query.until, operator.lt),
        (column.number, query.before, operator.lt),
        (column.number, query.after, operator.gt),
    ):
        if asked is not None:
            wanted = wanted.where(operation(compared, asked))
    forward = query.after is not None
    return wanted.order_by(column.number if forward else column.number.desc())
