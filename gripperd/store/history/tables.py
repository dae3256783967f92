"""Tables of the history; the migrations lead to exactly these."""

from sqlalchemy import (
    Boolean,
    Column,
    Float,
    Index,
    Integer,
    MetaData,
    String,
    Table,
    Text,
    UniqueConstraint,
)

metadata = MetaData()

commands = Table(
    "commands",
    metadata,
    Column("id", String, primary_key=True),
    Column("gripper", String, nullable=False),
    Column("key", String),
    Column("fingerprint", String, nullable=False),
    Column("life", Float, nullable=False),
    Column("created_at", Float, nullable=False),
    Column("final", Boolean, nullable=False),
    Column("document", Text, nullable=False),
    Column("digest", String(64), nullable=False),
    UniqueConstraint("gripper", "key", name="one_command_per_key"),
)

events = Table(
    "events",
    metadata,
    Column("number", Integer, primary_key=True, autoincrement=True),
    Column("at", Float, nullable=False),
    Column("gripper", String),
    Column("kind", String, nullable=False),
    Column("command", String),
    Column("life", Float),
    Column("entry", Integer),
    Column("document", Text, nullable=False),
    Column("digest", String(64), nullable=False),
    UniqueConstraint("life", "gripper", "entry", name="every_entry_once"),
    # Without it a number could be given again after the newest event was deleted.
    sqlite_autoincrement=True,
)

Index("commands_by_time", commands.c.gripper, commands.c.created_at)
Index("commands_open", commands.c.id, sqlite_where=commands.c.final.is_(False))
Index("events_by_time", events.c.at)
Index("events_by_command", events.c.command)
