"""Faults: what is wrong, what was, who has seen it; and the way out."""

from typing import Annotated

from fastapi import Query
from pydantic import Field

from gripperd.config.section import Section
from gripperd.control.fault import Fault
from gripperd.control.snapshot import GripperState
from gripperd.link.faults import Acknowledge, ListFaults, Reset
from gripperd.service.body import router
from gripperd.service.context import Daemon
from gripperd.service.fault_documents import FaultDocument, fault_document
from gripperd.service.leases import LeaseToken
from gripperd.service.rendering import Document
from gripperd.service.state import StateDocument, state_document

LONGEST_LIST = 200
"""So that a list fits into one message between the processes."""

routes = router("faults")


class Acknowledgement(Section):
    """Who has seen the fault."""

    by: str = Field(min_length=1, max_length=200)


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
    return Faults(faults=tuple(fault_document(each) for each in wanted))


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
    return fault_document(await daemon.control.ask(request, Fault))


@routes.post("/grippers/{gripper}/reset")
async def reset(daemon: Daemon, gripper: str, lease: LeaseToken) -> StateDocument:
    """Leave fault or emergency stop for `disabled`; nothing moves.

    409 until every latched fault is acknowledged and its cause is gone.
    """
    settings = daemon.gripper(gripper)
    state = await daemon.change(Reset(settings.name, lease), GripperState)
    return state_document(state, settings)
