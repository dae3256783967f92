"""Diagnoses as documents: what was asked for, how far it is, what was found."""

import json
from datetime import datetime
from typing import Any

from pydantic import Field

from gripperd.service.child import Progress
from gripperd.service.rendering import Document, optional
from gripperd.store.diagnoses import Status, StoredDiagnosis, Why


class ProgressDocument(Document):
    """How far a diagnosis is."""

    doing: str = Field(examples=["candidates, singles and pairs"])
    share: float = Field(description="0 to 1.", examples=[0.3])


class WhyDocument(Document):
    """Why something did not happen."""

    code: str
    message: str


class DiagnosisDocument(Document):
    """One diagnosis as it stands."""

    id: str
    recording: str = Field(description="Id of the recording.")
    gripper: str
    model: str = Field(description="Version that is judged.", examples=["reference"])
    seed: int
    status: Status
    progress: ProgressDocument | None = Field(description="Null once it is over.")
    created_at: datetime
    started_at: datetime | None
    completed_at: datetime | None
    verdict: str | None = Field(
        description="`named`, `none`, `unexplained`, `ambiguous` or `unusable`."
    )
    error: WhyDocument | None = Field(description="Why it failed.")
    objection: WhyDocument | None = Field(description="Why it cannot be accepted.")
    kept_as: str | None = Field(description="Version that was made of it.")
    result: dict[str, Any] | None = optional(
        "All that was found, as `gripperd diagnose --json` writes it."
    )


class Diagnoses(Document):
    """Every diagnosis, newest first, without the results."""

    diagnoses: tuple[DiagnosisDocument, ...]


class AcceptedDocument(Document):
    """The version that was made of a diagnosis."""

    name: str = Field(examples=["reference-1"])
    version: int = Field(examples=[1])
    parent: int = Field(description="Version that was judged.", examples=[0])
    grippers: tuple[str, ...] | None = Field(
        description="Those that go by it now; null when it was only kept."
    )


def diagnosis_document(
    found: StoredDiagnosis, progress: Progress | None = None, result: str | None = None
) -> DiagnosisDocument:
    """Describe a diagnosis for the outside.

    Parameters
    ----------
    found
        As it stands.
    progress
        How far it is, while it is not over.
    result
        What was found, as JSON.
    """
    how_far = None
    if progress is not None:
        how_far = ProgressDocument(doing=progress.what, share=progress.share)
    return DiagnosisDocument(
        id=found.id,
        recording=found.recording,
        gripper=found.gripper,
        model=found.model,
        seed=found.seed,
        status=found.status,
        progress=how_far,
        created_at=found.created_at,
        started_at=found.started_at,
        completed_at=found.completed_at,
        verdict=found.verdict,
        error=_why(found.error),
        objection=_why(found.objection),
        kept_as=found.kept_as,
        result=None if result is None else json.loads(result),
    )


def _why(why: Why | None) -> WhyDocument | None:
    if why is None:
        return None
    return WhyDocument(code=why.code, message=why.message)
