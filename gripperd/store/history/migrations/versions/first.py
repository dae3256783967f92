"""Commands and events."""

import sqlalchemy as sa
from alembic import op

revision = "first"
down_revision = None


def upgrade() -> None:
    """Make both tables."""
    op.create_table(
        "commands",
        sa.Column("id", sa.String, primary_key=True),
        sa.Column("gripper", sa.String, nullable=False),
        sa.Column("key", sa.String),
        sa.Column("fingerprint", sa.String, nullable=False),
        sa.Column("life", sa.Float, nullable=False),
        sa.Column("created_at", sa.Float, nullable=False),
        sa.Column("final", sa.Boolean, nullable=False),
        sa.Column("document", sa.Text, nullable=False),
        sa.Column("digest", sa.String(64), nullable=False),
        sa.UniqueConstraint("gripper", "key", name="one_command_per_key"),
    )
    op.create_table(
        "events",
        sa.Column("number", sa.Integer, primary_key=True, autoincrement=True),
        sa.Column("at", sa.Float, nullable=False),
        sa.Column("gripper", sa.String),
        sa.Column("kind", sa.String, nullable=False),
        sa.Column("command", sa.String),
        sa.Column("life", sa.Float),
        sa.Column("entry", sa.Integer),
        sa.Column("document", sa.Text, nullable=False),
        sa.Column("digest", sa.String(64), nullable=False),
        sa.UniqueConstraint("life", "gripper", "entry", name="every_entry_once"),
        sqlite_autoincrement=True,
    )
    op.create_index("commands_by_time", "commands", ["gripper", "created_at"])
    op.create_index(
        "commands_open", "commands", ["id"], sqlite_where=sa.text("final IS 0")
    )
    op.create_index("events_by_time", "events", ["at"])
    op.create_index("events_by_command", "events", ["command"])
