"""Faults: what is wrong, what was, who has seen it; and the way out."""

from datetime import datetime
from typing import Annotated

from fastapi import Query
from pydantic import Field

from gripperd.config.section import Section
from gripperd.control.faults import Fault
from gripperd.control.monitors.policy import Cause, Reaction
from gripperd.control.snapshot import GripperState
from gripperd.link.faults import Acknowledge, ListFaults, Reset
from gripperd.service.body import router
from gripperd.service.context import Daemon
from gripperd.service.leases import LeaseToken
from gripperd.service.rendering import Document, optional, timestamp
from gripperd.service.state import StateDocument, state_document

LONGEST_LIST = 200
"""So that a list fits into one message between the processes."""

routes = router("faults")


class Acknowledgement(Section):
    """Who has seen the fault."""

    by: str = Field(min_length=1, max_length=200)


class FaultDocument(Document):
    """Something that went wrong, and what became of it."""

    id: str
    cause: Cause
    subject: str | None = optional("Which one, where there are several.")
    message: str
    active: bool = Field(description="Its cause is there, or it is latched.")
    latched: bool = Field(
        description="Nothing moves until it is acknowledged and reset."
    )
    reaction: Reaction = Field(description="What was done about it.")
    raised_at: datetime
    cleared_at: datetime | None = optional("When the cause was gone.")
    acknowledged_at: datetime | None = None
    acknowledged_by: str | None = None
    reset_at: datetime | None = optional("When it was let go of.")


class Faults(Document):
    """The last faults, newest first."""

    faults: tuple[FaultDocument, ...]


@routes.get("/grippers/{gripper}/faults")
async def list_faults(
    daemon: Daemon,
    gripper: str,
    limit: Annotated[int, Query(ge=1, le=LONGEST_LIST)] = 50,
    active: Annotated[bool | None, Query(description="Only such.")] = None,
) -> Faults:
    """Active and past faults."""
    request = ListFaults(daemon.gripper(gripper).name, limit)
    found = await daemon.control.ask(request, list[Fault])
    wanted = (each for each in found if active in {None, each.active})
    return Faults(faults=tuple(_document(each) for each in wanted))


@routes.post("/grippers/{gripper}/faults/{id}/acknowledge")
async def acknowledge_fault(
    daemon: Daemon,
    gripper: str,
    id: str,
    asked: Acknowledgement,
    lease: LeaseToken,
) -> FaultDocument:
    """Say who has seen it; the first one counts. Nothing else changes."""
    request = Acknowledge(daemon.gripper(gripper).name, id, asked.by, lease)
    return _document(await daemon.control.ask(request, Fault))


@routes.post("/grippers/{gripper}/reset")
async def reset(daemon: Daemon, gripper: str, lease: LeaseToken) -> StateDocument:
    """Leave fault or emergency stop for `disabled`; nothing moves.

    409 until every latched fault is acknowledged and its cause is gone.
    """
    settings = daemon.gripper(gripper)
    state = await daemon.change(Reset(settings.name, lease), GripperState)
    return state_document(state, settings)


def _document(fault: Fault) -> FaultDocument:
    return FaultDocument(
        id=fault.id,
        cause=fault.cause,
        subject=fault.subject or None,
        message=fault.message,
        active=fault.active,
        latched=fault.latched,
        reaction=fault.reaction,
        raised_at=timestamp(fault.raised_at),
        cleared_at=_when(fault.cleared_at),
        acknowledged_at=_when(fault.acknowledged_at),
        acknowledged_by=fault.acknowledged_by,
        reset_at=_when(fault.reset_at),
    )


def _when(seconds: float | None) -> datetime | None:
    return None if seconds is None else timestamp(seconds)
