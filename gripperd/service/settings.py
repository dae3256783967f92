"""The settings: what they said when they were read, and what a change of them does."""

from asyncio import to_thread
from collections.abc import Mapping
from dataclasses import replace
from datetime import datetime

import structlog
from pydantic import Field

from gripperd.config import Settings, load_settings
from gripperd.config.change import changes
from gripperd.service.body import router
from gripperd.service.context import Context, Daemon
from gripperd.service.rendering import Document, timestamp
from gripperd.store import with_active_models

AT_ONCE = "profiles."
"""Parts of this name count from the next command on; others from the next start on."""

log = structlog.get_logger()
routes = router("config")


class ConfigDocument(Document):
    """What the daemon was told to do."""

    source: str = Field(description="The file.")
    loaded_at: datetime = Field(description="When the service read it at its start.")
    content: Mapping[str, object] = Field(description="The file as it was then.")


class ValidationDocument(Document):
    """A file that is usable, with everything it names; else a problem says where."""

    source: str
    warnings: tuple[str, ...]
    changed: tuple[str, ...] = Field(
        description="Parts that are not as the service goes by them now."
    )
    at_restart: tuple[str, ...] = Field(
        description="Those of them that wait for a restart of the daemon."
    )


class ReloadDocument(ValidationDocument):
    """What became of the changes."""

    applied: tuple[str, ...] = Field(
        description="Those that count from the next command on."
    )


@routes.get("/config")
async def read_config(daemon: Daemon) -> ConfigDocument:
    """The settings file as it was read."""
    return ConfigDocument(
        source=str(daemon.settings.source),
        loaded_at=timestamp(daemon.started_at),
        content=daemon.settings.content,
    )


@routes.post("/config/validate")
async def validate_config(daemon: Daemon) -> ValidationDocument:
    """Check the file as it is now, as the next start will; nothing else is done."""
    return _validation(daemon, await _read(daemon))


@routes.post("/config/reload")
async def reload_config(daemon: Daemon) -> ReloadDocument:
    """Read the file again. An unusable one is refused whole.

    Profiles count from the next command on; what is held stays held as it was. All
    else waits for a restart, and until then goes on as it is.
    """
    async with daemon.library.changing:
        new = await _read(daemon)
        found = _validation(daemon, new)
        applied = tuple(part for part in found.changed if part.startswith(AT_ONCE))
        if applied:
            await daemon.library.renew(new.profiles)
    log.info("settings are read", applied=applied, at_restart=found.at_restart)
    return ReloadDocument(**dict(found), applied=applied)


async def _read(daemon: Context) -> Settings:
    def read() -> Settings:
        settings = load_settings(daemon.settings.source)
        # The next start would refuse an active version that does not fit them.
        with_active_models(settings)
        return settings

    return await to_thread(read)


def _validation(daemon: Context, new: Settings) -> ValidationDocument:
    current = replace(daemon.settings, profiles=daemon.library.originals)
    changed = tuple(changes(current, new))
    return ValidationDocument(
        source=str(new.source),
        warnings=new.warnings,
        changed=changed,
        at_restart=tuple(part for part in changed if not part.startswith(AT_ONCE)),
    )
