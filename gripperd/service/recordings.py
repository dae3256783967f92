"""Recordings: send one in, see what was found in it."""

from asyncio import to_thread
from datetime import UTC, datetime
from typing import Annotated

from fastapi import Query, Request, Response
from pydantic import BaseModel, ConfigDict, Field

from gripperd.service.body import router
from gripperd.service.child import Read, work
from gripperd.service.context import Daemon
from gripperd.service.rendering import Document, to
from gripperd.service.upload import TYPES, check_header, received
from gripperd.store.recordings import StoredRecording

routes = router("recordings")

BODY = {
    "requestBody": {
        "required": True,
        "description": "A table, one row a sample: CSV or Parquet, up to 64 MB.",
        "content": {
            kind: {"schema": {"type": "string", "format": "binary"}} for kind in TYPES
        }
        | {
            "text/csv": {
                "schema": {"type": "string"},
                "example": "run,t_s,pressure_kPa,contraction,force_N\n"
                "up_1,0.00,100.2,0.050,214.9\n",
            }
        },
    }
}


class RecordingQuery(BaseModel):
    """What a recording is to be called."""

    model_config = ConfigDict(extra="forbid")

    name: str = Field(
        default="recording",
        pattern=r"^[A-Za-z0-9][A-Za-z0-9_.-]{0,79}$",
        description="Name of its file; messages and versions call it that.",
        examples=["sweeps.csv"],
    )


class RunDocument(Document):
    """One run: a contiguous experiment."""

    name: str
    samples: int
    duration_s: float


class RejectedDocument(Document):
    """Samples that are not believed."""

    run: str
    column: str
    count: int
    reason: str


class RecordingDocument(Document):
    """A recording, and what was found in it."""

    id: str = Field(description="SHA-256 of its content.")
    name: str = Field(examples=["sweeps"])
    file: str = Field(examples=["sweeps.csv"])
    size_octets: int
    created_at: datetime
    columns: tuple[str, ...] = Field(
        description="What was measured.", examples=[["t_s", "pressure_kPa", "force_N"]]
    )
    runs: tuple[RunDocument, ...]
    rejected_samples: tuple[RejectedDocument, ...]
    remarks: tuple[str, ...]


class Recordings(Document):
    """Every recording, newest first."""

    recordings: tuple[RecordingDocument, ...]


@routes.post("/recordings", status_code=201, openapi_extra=BODY)
async def send_recording(
    daemon: Daemon,
    query: Annotated[RecordingQuery, Query()],
    request: Request,
    response: Response,
) -> RecordingDocument:
    """Keep a recording; 200 instead of 201 when the same content is kept already.

    What cannot be used is refused with its line or column.
    """
    headers = request.headers
    check_header(headers.get("content-type"), headers.get("content-length"))
    stem = query.name.removesuffix(".csv").removesuffix(".parquet")
    with daemon.recordings.draft() as draft:
        file = await received(request.stream(), draft, stem)
        async with daemon.reading:
            read = await work("read", file.name, reply=Read, folder=draft)
        found = StoredRecording(
            file=file.name,
            size=file.stat().st_size,
            created_at=datetime.now(UTC),
            contents=read.contents,
        )
        if not await to_thread(daemon.recordings.keep, draft, found):
            response.status_code = 200
    response.headers["location"] = f"/v1/recordings/{found.id}"
    return _document(await to_thread(daemon.recordings.get, found.id))


@routes.get("/recordings")
async def list_recordings(daemon: Daemon) -> Recordings:
    """Every recording, newest first."""
    found = await to_thread(daemon.recordings.all)
    return Recordings(recordings=tuple(map(_document, found)))


@routes.get("/recordings/{id}")
async def read_recording(daemon: Daemon, id: str) -> RecordingDocument:
    """One recording."""
    return _document(await to_thread(daemon.recordings.get, id))


def _document(recording: StoredRecording) -> RecordingDocument:
    contents = recording.contents
    return RecordingDocument.model_validate(
        {
            "id": recording.id,
            "name": contents.name,
            "file": recording.file,
            "size_octets": recording.size,
            "created_at": recording.created_at,
            "columns": contents.columns,
            "runs": [
                RunDocument(
                    name=run.name,
                    samples=run.samples,
                    duration_s=to("s", run.duration_s),
                )
                for run in contents.runs
            ],
            "rejected_samples": contents.rejected_samples,
            "remarks": contents.remarks,
        },
        from_attributes=True,
    )
