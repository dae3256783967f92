"""Diagnoses that were asked for, and what came of them."""

from dataclasses import dataclass, replace
from datetime import datetime
from enum import StrEnum
from pathlib import Path

from pydantic import ValidationError

from gripperd.config import Complaint, ModelFile, Provenance, load_model, model_text
from gripperd.config.durable import replace_file
from gripperd.config.sealed import check_seal, sealed
from gripperd.errors import ConfigError
from gripperd.store.records import Records, writing

RESULT, REPORT = "result.json", "report.html"
MODEL = "model.yaml"
"""The model that is judged, as it was when it was asked for."""
BETTER, PROVENANCE = "better.yaml", "provenance.json"
"""The model with what was named, and where it comes from; not there without a name."""


class Status(StrEnum):
    """Where a diagnosis stands; the last three are final."""

    QUEUED = "queued"
    RUNNING = "running"
    SUCCEEDED = "succeeded"
    """A verdict was reached, any verdict."""
    FAILED = "failed"
    CANCELLED = "cancelled"


@dataclass(frozen=True, slots=True, kw_only=True)
class Why:
    """Why something did not happen."""

    code: str
    message: str


INTERRUPTED = Why(
    code="interrupted",
    message="the service ended before the diagnosis did; ask for it again",
)


@dataclass(frozen=True, slots=True, kw_only=True)
class StoredDiagnosis:
    """One diagnosis as it stands."""

    id: str
    recording: str
    """Id of the recording."""
    gripper: str
    model: str
    """Name of the version that is judged."""
    version: int
    """Its number."""
    seed: int
    created_at: datetime
    status: Status = Status.QUEUED
    started_at: datetime | None = None
    completed_at: datetime | None = None
    verdict: str | None = None
    error: Why | None = None
    """Why it failed."""
    objection: Why | None = None
    """Why there is nothing to accept, once it has succeeded."""
    unprinted: str | None = None
    """Why there is no report."""
    kept_as: str | None = None
    """Name of the version that was made of it."""

    @property
    def final(self) -> bool:
        """Whether nothing more will happen."""
        return self.status not in {Status.QUEUED, Status.RUNNING}


class Diagnoses:
    """The diagnoses in a folder.

    Parameters
    ----------
    folder
        Where they are kept.
    """

    def __init__(self, folder: Path) -> None:
        self._records = Records(folder, StoredDiagnosis, "diagnosis")

    def all(self) -> list[StoredDiagnosis]:
        """Every diagnosis, newest first."""
        return sorted(self._records.all(), key=lambda one: one.created_at, reverse=True)

    def get(self, diagnosis: str) -> StoredDiagnosis:
        """One diagnosis; raises NotFound when there is none of that id."""
        return self._records.get(diagnosis)

    def put(self, diagnosis: StoredDiagnosis) -> None:
        """Write down how one stands; raises Refused when the disk does not take it."""
        self._records.put(diagnosis.id, diagnosis)

    def place(self, diagnosis: str) -> Path:
        """Folder with everything that belongs to one."""
        return self._records.place(diagnosis)

    def give_up_interrupted(self, now: datetime) -> None:
        """Call those failed that an earlier life of the service did not end."""
        for one in self.all():
            if not one.final:
                self.put(
                    replace(
                        one,
                        status=Status.FAILED,
                        completed_at=now,
                        error=INTERRUPTED,
                    )
                )


def write_improvement(model: ModelFile, made: Provenance, folder: Path) -> None:
    """Keep a better model beside the diagnosis that named what it has.

    Raises
    ------
    Refused
        The disk is full or cannot be written.
    """
    with writing(folder):
        replace_file(folder / BETTER, sealed(model_text(model)))
        replace_file(folder / PROVENANCE, made.model_dump_json())


def read_improvement(folder: Path) -> tuple[ModelFile, Provenance]:
    """Read what :func:`write_improvement` has written.

    Raises
    ------
    ConfigError
        One of the two is damaged.
    """
    better, made = folder / BETTER, folder / PROVENANCE
    check_seal(better)
    try:
        provenance = Provenance.model_validate_json(made.read_bytes())
    except (OSError, ValidationError) as error:
        raise ConfigError(Complaint("is damaged", source=str(made))) from error
    return load_model(better), provenance
