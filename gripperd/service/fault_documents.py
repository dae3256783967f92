"""A fault as a document."""

from datetime import datetime

from pydantic import Field

from gripperd.control.fault import Fault, Step
from gripperd.control.monitors.policy import Cause, Reaction
from gripperd.service.rendering import Document, optional, timestamp


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
    way_out: tuple[Step, ...] = Field(
        description="What is left to be done, in order; empty once it is over."
    )
    reaction: Reaction = Field(description="What was done about it.")
    raised_at: datetime
    cleared_at: datetime | None = optional("When the cause was gone.")
    acknowledged_at: datetime | None = None
    acknowledged_by: str | None = None
    reset_at: datetime | None = optional("When it was let go of.")


def fault_document(fault: Fault) -> FaultDocument:
    """Describe a fault for the outside."""
    return FaultDocument(
        id=fault.id,
        cause=fault.cause,
        subject=fault.subject or None,
        message=fault.message,
        active=fault.active,
        latched=fault.latched,
        way_out=fault.way_out,
        reaction=fault.reaction,
        raised_at=timestamp(fault.raised_at),
        cleared_at=_when(fault.cleared_at),
        acknowledged_at=_when(fault.acknowledged_at),
        acknowledged_by=fault.acknowledged_by,
        reset_at=_when(fault.reset_at),
    )


def _when(seconds: float | None) -> datetime | None:
    return None if seconds is None else timestamp(seconds)
