"""Versions of the models: read them, and let the grippers go by another one."""

from asyncio import to_thread
from collections.abc import Callable, Mapping
from datetime import datetime
from typing import Annotated, TypeVar

from fastapi import Query
from pydantic import BaseModel, ConfigDict, Field

from gripperd.config import model_document
from gripperd.config.lineage import Gap
from gripperd.errors import ConfigError, Refused
from gripperd.service.body import router
from gripperd.service.context import Context, Daemon
from gripperd.service.rendering import Document
from gripperd.store import Version, Versions, versions_of
from gripperd.store.activation import activation

T = TypeVar("T")

routes = router("models")


class ModelQuery(BaseModel):
    """Whose model."""

    model_config = ConfigDict(extra="forbid")

    gripper: str | None = Field(
        default=None,
        description="Whose model; by default that of the first.",
        examples=["g0"],
    )


ForGripper = Annotated[ModelQuery, Query()]


class VersionDocument(Document):
    """One version of a model, and what it was worth."""

    name: str = Field(examples=["reference-1"])
    version: int = Field(description="0 is the configured model.", examples=[1])
    active: bool = Field(description="Written down as the one to go by.")
    parent: int | None = Field(description="Version it was made from.", examples=[0])
    created_at: datetime | None
    added: tuple[str, ...] = Field(
        description="Effects that were added, and constants that were adjusted.",
        examples=[["creep"]],
    )
    gap: Gap | None = Field(description="On runs that took no part in fitting.")


class ModelDocument(VersionDocument):
    """One version with everything that its file says."""

    content: Mapping[str, object] = Field(description="The model file.")


class Models(Document):
    """Every version of the model of a gripper."""

    gripper: str
    grippers: tuple[str, ...] = Field(description="All that share the model.")
    active: str = Field(description="Name of the version that is active.")
    versions: tuple[VersionDocument, ...]
    complaints: tuple[str, ...] = Field(
        description="What is wrong with versions that cannot be read."
    )


class ActivationDocument(Document):
    """What became of an activation; from the next prediction on it counts."""

    name: str = Field(description="The version that is active now.")
    version: int
    grippers: tuple[str, ...] = Field(description="Those that go by it now.")


@routes.get("/models")
async def list_models(daemon: Daemon, query: ForGripper) -> Models:
    """Every version of a gripper's model, with the gap that it closed."""
    name, versions = _versions(daemon, query)
    shelf = await to_thread(_read, versions.all)
    shared = daemon.settings.grippers[name].model.name
    active = {one.number: one.name for one in shelf.versions}
    return Models(
        gripper=name,
        grippers=tuple(
            each.name
            for each in daemon.settings.grippers.values()
            if each.model.name == shared
        ),
        active=active.get(shelf.active, f"{shared}-{shelf.active}"),
        versions=tuple(
            VersionDocument.model_validate(_facts(one, shelf.active))
            for one in shelf.versions
        ),
        complaints=shelf.complaints,
    )


@routes.get("/models/{version}")
async def read_model(daemon: Daemon, version: str, query: ForGripper) -> ModelDocument:
    """One version by its name, its number, or `active`, as a model file has it."""
    _, versions = _versions(daemon, query)

    def read() -> tuple[Version, int]:
        return versions.get(version), versions.active

    found, active = await to_thread(_read, read)
    facts = _facts(found, active) | {"content": model_document(found.model)}
    return ModelDocument.model_validate(facts)


@routes.post("/models/{version}/activate")
async def activate_model(
    daemon: Daemon, version: str, query: ForGripper
) -> ActivationDocument:
    """Let control go by a version, now; refused while a gripper may hold something.

    No current is written by it. To go back, activate the parent.
    """
    return await activated(daemon, version, _versions(daemon, query)[0])


async def activated(
    daemon: Context, version: int | str, gripper: str
) -> ActivationDocument:
    """Let a version become the active one, here and in control.

    Raises
    ------
    NotFound
        There is no such version.
    Refused
        It cannot be used, or a gripper moves or may hold something.
    LinkError
        Control does not answer; nothing was changed.
    """
    async with daemon.activating:
        found = await to_thread(activation, daemon.settings, gripper, version)
        try:
            await found.take_up(daemon.control)
        finally:
            for name in found.grippers:
                daemon.states.forget(name)
        for name in found.grippers:
            await daemon.up_to_date(daemon.fleet[name])
    return ActivationDocument(
        name=found.version.name, version=found.version.number, grippers=found.grippers
    )


def _versions(daemon: Context, query: ModelQuery) -> tuple[str, Versions]:
    """Name of the gripper that is asked about, and the versions of its model."""
    if query.gripper is None:
        name = next(iter(daemon.settings.grippers))
    else:
        name = daemon.gripper(query.gripper).name
    return name, versions_of(daemon.settings, daemon.settings.grippers[name])


def _read(what: Callable[[], T]) -> T:
    try:
        return what()
    except ConfigError as damaged:
        raise Refused(str(damaged), code="model-unusable") from damaged


def _facts(version: Version, active: int) -> dict[str, object]:
    lineage = version.model.lineage
    made = lineage and lineage.provenance
    return {
        "name": version.name,
        "version": version.number,
        "active": version.number == active,
        "parent": lineage and lineage.parent,
        "created_at": lineage and lineage.created_at,
        "added": tuple(effect.name for effect in made.effects) if made else (),
        "gap": made and made.gap,
    }
