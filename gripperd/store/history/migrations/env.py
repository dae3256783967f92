"""Runs the migrations on a connection that is open already."""

from alembic import context

from gripperd.store.history.tables import metadata

context.configure(
    connection=context.config.attributes["connection"], target_metadata=metadata
)
context.run_migrations()
