"""Events as documents: what happened, in words and in values."""

from datetime import datetime
from enum import StrEnum

from gripperd.control.journal import Entry, Happening
from gripperd.control.states import Grip, Machine
from gripperd.service.command_documents import CommandDocument, command_document
from gripperd.service.rendering import Document, optional, timestamp
from gripperd.store.history import CommandRecord, EventRecord


class EventKind(StrEnum):
    """What an event is about."""

    COMMAND = Happening.COMMAND.value
    STATE = Happening.STATE.value
    ADOPTION = Happening.ADOPTION.value
    FAULT = Happening.FAULT.value
    LEASE = Happening.LEASE.value
    CONTROL = "control"
    """The control process began a new life, or was not heard for too long."""
    STORAGE = "storage"
    """The history itself was damaged."""


class EventDocument(Document):
    """One thing that happened."""

    number: int | None = optional("Counts on over restarts; none: not on disk yet.")
    at: datetime
    kind: EventKind
    gripper: str | None = None
    text: str
    machine: Machine | None = optional("Its state from then on.")
    grip: Grip | None = optional("Its state from then on.")
    command: CommandDocument | None = optional("As it stood then.")


def event_of(entry: Entry, gripper: str) -> EventDocument:
    """Describe an entry of a journal."""
    return EventDocument(
        at=timestamp(entry.at),
        kind=EventKind(entry.kind.value),
        gripper=gripper,
        text=entry.text,
        machine=entry.machine,
        grip=entry.grip,
        command=command_document(entry.command) if entry.command else None,
    )


def event_record(
    event: EventDocument, life: float | None = None, entry: int | None = None
) -> EventRecord:
    """Make what is kept of an event."""
    return EventRecord(
        at=event.at.timestamp(),
        kind=event.kind.value,
        gripper=event.gripper,
        command=None if event.command is None else event.command.id,
        life=life,
        entry=entry,
        document=event.model_dump_json(),
    )


def kept_event(record: EventRecord) -> EventDocument:
    """Read an event that was kept."""
    event = EventDocument.model_validate_json(record.document)
    return event.model_copy(update={"number": record.number})


def command_record(
    command: CommandDocument, life: float, key: str | None = None, fingerprint: str = ""
) -> CommandRecord:
    """Make what is kept of a command; without a key when it is known already."""
    return CommandRecord(
        id=command.id,
        gripper=command.gripper,
        key=key,
        fingerprint=fingerprint,
        life=life,
        created_at=command.created_at.timestamp(),
        final=command.completed_at is not None,
        document=command.model_dump_json(),
    )
