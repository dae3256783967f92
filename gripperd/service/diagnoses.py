"""Diagnoses: ask for one, follow it, read what was found, keep it as a version."""

from asyncio import to_thread
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from uuid import uuid4

from fastapi import Response
from pydantic import Field
from starlette.responses import HTMLResponse

from gripperd.config import model_text
from gripperd.config.durable import replace_file
from gripperd.config.section import Section
from gripperd.errors import ConfigError, InputError, LinkError, NotFound, Refused
from gripperd.service.body import router
from gripperd.service.context import Context, Daemon
from gripperd.service.diagnosis_documents import (
    AcceptedDocument,
    Diagnoses,
    DiagnosisDocument,
    diagnosis_document,
)
from gripperd.service.models import activated
from gripperd.store import ACTIVE, versions_of
from gripperd.store.acceptance import accept
from gripperd.store.diagnoses import MODEL, REPORT, RESULT, Status, StoredDiagnosis
from gripperd.store.records import writing

POLICY = (
    "default-src 'none'; style-src 'unsafe-inline'; img-src data:;"
    " frame-ancestors 'none'"
)

routes = router("diagnoses")


class DiagnosisRequest(Section):
    """What to diagnose."""

    recording: str = Field(
        description="Id of the recording.",
        examples=["2c26b46b68ffc68ff99b453c1d30413413422d706483bfa0f98a5e886266e7ae"],
    )
    gripper: str | None = Field(
        default=None, description="Whose model; by default that of the first."
    )
    model: str = Field(
        default=ACTIVE,
        description="Name or number of the version to judge; by default the active.",
        examples=["reference"],
    )
    seed: int = Field(
        default=0,
        ge=0,
        le=2**32 - 1,
        description="Of every random draw: the same seed gives the same answer.",
    )


class AcceptRequest(Section):
    """What is to become of the version that is kept."""

    activate: bool = Field(default=False, description="Go by it at once.")


@routes.post("/diagnoses", status_code=201)
async def ask_diagnosis(
    daemon: Daemon, asked: DiagnosisRequest, response: Response
) -> DiagnosisDocument:
    """Find what a model lacks; one runs at a time, and control waits for none."""
    diagnosing = daemon.diagnosing
    diagnosing.check_room()
    found = await to_thread(_written, daemon, asked)
    diagnosing.add(found)
    response.headers["location"] = f"/v1/diagnoses/{found.id}"
    return diagnosis_document(*diagnosing.standing(found))


@routes.get("/diagnoses")
async def list_diagnoses(daemon: Daemon) -> Diagnoses:
    """Every diagnosis, newest first, without the results."""
    found = await to_thread(daemon.diagnosing.kept.all)
    standing = map(daemon.diagnosing.standing, found)
    return Diagnoses(diagnoses=tuple(diagnosis_document(*one) for one in standing))


@routes.get("/diagnoses/{id}")
async def read_diagnosis(daemon: Daemon, id: str) -> DiagnosisDocument:
    """One diagnosis: how far it is, and once it is over, what was found."""
    found, progress = await to_thread(daemon.diagnosing.now, id)
    result = None
    if found.status is Status.SUCCEEDED:
        result = await to_thread(_file, found, RESULT, daemon)
    return diagnosis_document(found, progress, result)


@routes.get("/diagnoses/{id}/report", response_class=HTMLResponse)
async def read_report(daemon: Daemon, id: str) -> HTMLResponse:
    """The report: one page that needs nothing but a browser."""
    found = await _succeeded(daemon, id)
    if found.unprinted is not None:
        raise NotFound(f"there is no report: {found.unprinted}", key="id")
    content = await to_thread(_file, found, REPORT, daemon)
    return HTMLResponse(content, headers={"content-security-policy": POLICY})


@routes.delete("/diagnoses/{id}", status_code=202)
async def cancel_diagnosis(daemon: Daemon, id: str) -> DiagnosisDocument:
    """End a diagnosis that waits or runs."""
    return diagnosis_document(await daemon.diagnosing.cancel(id))


@routes.post("/diagnoses/{id}/accept", status_code=201)
async def accept_diagnosis(
    daemon: Daemon, id: str, response: Response, asked: AcceptRequest | None = None
) -> AcceptedDocument:
    """Keep what was named as a new version of the model; go by it only if asked."""
    async with daemon.activating:
        found = await _succeeded(daemon, id)
        with _usable():
            version = await to_thread(
                accept,
                found,
                daemon.diagnosing.kept,
                daemon.settings,
                datetime.now(UTC),
            )
    response.headers["location"] = f"/v1/models/{version.name}?gripper={found.gripper}"
    kept = AcceptedDocument(
        name=version.name, version=version.number, parent=found.version, grippers=None
    )
    if asked is None or not asked.activate:
        return kept
    try:
        active = await activated(daemon, version.number, found.gripper)
    except (Refused, LinkError) as error:
        message = f"kept as {version.name}, which is not active: {error}"
        afterwards = f"POST /v1/models/{version.name}/activate afterwards"
        if isinstance(error, LinkError):
            raise type(error)(f"{message}; {afterwards}") from error
        hints = (*error.hints, afterwards)
        raise Refused(message, code=error.code, hints=hints) from error
    return kept.model_copy(update={"grippers": active.grippers})


def _written(daemon: Context, asked: DiagnosisRequest) -> StoredDiagnosis:
    """Write down what is asked for, with the model as it is now."""
    gripper = daemon.chosen_gripper(asked.gripper).name
    versions = versions_of(daemon.settings, daemon.settings.grippers[gripper])
    with _key("recording"):
        daemon.recordings.get(asked.recording)
    with _key("model"), _usable():
        version = versions.get(asked.model)
    if version.number == 0 and daemon.fleet.edited(gripper):
        message = f"control goes by another {version.name}: its file was edited"
        hints = ("start the daemon again",)
        raise Refused(message, code="model-changed", hints=hints)
    found = StoredDiagnosis(
        id=uuid4().hex,
        recording=asked.recording,
        gripper=gripper,
        model=version.name,
        version=version.number,
        seed=asked.seed,
        created_at=datetime.now(UTC),
    )
    kept = daemon.diagnosing.kept
    place = kept.place(found.id)
    with writing(place):
        replace_file(place / MODEL, model_text(version.model))
    kept.put(found)
    return found


@contextmanager
def _key(name: str) -> Iterator[None]:
    """Let what is not there be a value of the body that cannot be used."""
    try:
        yield
    except NotFound as missing:
        raise InputError(str(missing), key=name) from missing


@contextmanager
def _usable() -> Iterator[None]:
    """Let a file that is damaged be no fault of the body."""
    try:
        yield
    except ConfigError as damaged:
        raise Refused(str(damaged), code="model-unusable") from damaged


async def _succeeded(daemon: Context, diagnosis: str) -> StoredDiagnosis:
    found, _ = await to_thread(daemon.diagnosing.now, diagnosis)
    if found.status is Status.SUCCEEDED:
        return found
    code = "nothing-found" if found.final else "not-finished"
    message = f"diagnosis {diagnosis} is {found.status}: nothing was found"
    raise Refused(message, code=code)


def _file(found: StoredDiagnosis, name: str, daemon: Context) -> str:
    place = daemon.diagnosing.kept.place(found.id)
    try:
        return (place / name).read_text(encoding="utf-8")
    except OSError as error:
        message = f"{name} of diagnosis {found.id} cannot be read: {error.strerror}"
        raise NotFound(message, key="id") from error
