"""What happened, from the disk and as it happens."""

from datetime import datetime
from typing import Annotated

from fastapi import Header, Query
from pydantic import AwareDatetime, BaseModel, ConfigDict, Field
from starlette.responses import Response

from gripperd.errors import InputError, Refused
from gripperd.service.body import router
from gripperd.service.context import Daemon
from gripperd.service.event_documents import EventDocument, EventKind, kept_event
from gripperd.service.event_stream import EventStream
from gripperd.service.rendering import Document
from gripperd.store.history import EventQuery

LONGEST_PAGE = 500

routes = router("history")


class HistoryQuery(BaseModel):
    """Which events."""

    model_config = ConfigDict(extra="forbid")

    kind: list[EventKind] = Field(default=[], description="May be given repeatedly.")
    gripper: str | None = None
    command: str | None = Field(default=None, description="Id of a command.")
    since: AwareDatetime | None = Field(default=None, description="From then on.")
    until: AwareDatetime | None = Field(default=None, description="Before then.")
    before: int | None = Field(
        default=None, ge=1, description="`next` of the page before."
    )
    limit: int = Field(default=100, ge=1, le=LONGEST_PAGE)


class HistoryDocument(Document):
    """Events, newest first."""

    events: tuple[EventDocument, ...]
    next: int | None = Field(description="Goes on there; null at the end.")


@routes.get("/history")
async def read_history(
    daemon: Daemon, asked: Annotated[HistoryQuery, Query()]
) -> HistoryDocument:
    """Commands, faults, adoptions and changes of state, kept for 90 days."""
    query = EventQuery(
        kinds=tuple(asked.kind),
        gripper=asked.gripper,
        command=asked.command,
        since=_seconds(asked.since),
        until=_seconds(asked.until),
        before=asked.before,
        limit=asked.limit,
    )
    found = await daemon.past.archive.do(lambda history: history.events(query))
    more = len(found) == asked.limit
    return HistoryDocument(
        events=tuple(map(kept_event, found)), next=found[-1].number if more else None
    )


@routes.get("/events", response_class=Response)
async def follow_events(
    daemon: Daemon, last_event_id: Annotated[str | None, Header()] = None
) -> Response:
    """Server-sent events; `Last-Event-ID` brings what was missed first.

    An event without an id is not on disk: the disk fails, see `/health/ready`. A
    reader that does not keep up is dropped, and comes back with the id it had.
    """
    past = daemon.past
    if past.broadcast.full:
        message = "too many follow the events already"
        raise Refused(message, code="too-many-readers")
    return EventStream(past.archive, past.broadcast, _number(last_event_id))


def _seconds(moment: datetime | None) -> float | None:
    return None if moment is None else moment.timestamp()


def _number(last_event_id: str | None) -> int | None:
    if last_event_id is None or last_event_id == "":
        return None
    if not (last_event_id.isascii() and last_event_id.isdecimal()):
        message = f"Last-Event-ID {last_event_id[:80]!r} is not the id of an event"
        raise InputError(message, key="Last-Event-ID")
    return min(int(last_event_id[:19]), 2**62)
