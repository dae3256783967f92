"""Recordings that were sent in, by the hash of their content."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import datetime
from hashlib import file_digest
from pathlib import Path
from shutil import rmtree
from tempfile import mkdtemp

from gripperd.errors import NotFound
from gripperd.store.records import Records, writing

DRAFT = ".draft-"


@dataclass(frozen=True, slots=True, kw_only=True)
class RunContents:
    """One run of a recording."""

    name: str
    samples: int
    duration_s: float


@dataclass(frozen=True, slots=True, kw_only=True)
class RejectedSamples:
    """Samples that are not believed, and why."""

    run: str
    column: str
    count: int
    reason: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Contents:
    """What the reader found in a file."""

    name: str
    """As a diagnosis calls it: the name of the file without its ending."""
    sha256: str
    columns: tuple[str, ...]
    """With their unit, such as ``force_N``."""
    runs: tuple[RunContents, ...]
    rejected_samples: tuple[RejectedSamples, ...]
    remarks: tuple[str, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class StoredRecording:
    """A recording that is kept."""

    file: str
    size: int
    """Of the file. [octets]"""
    created_at: datetime
    contents: Contents

    @property
    def id(self) -> str:
        """Hash of its content (FIPS 180-4, SHA-256)."""
        return self.contents.sha256


class Recordings:
    """The recordings in a folder.

    Parameters
    ----------
    folder
        Where they are kept.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._records = Records(folder, StoredRecording, "recording")

    def all(self) -> list[StoredRecording]:
        """Every recording, newest first."""
        return sorted(self._records.all(), key=lambda one: one.created_at, reverse=True)

    def get(self, recording: str) -> StoredRecording:
        """One recording; raises NotFound when there is none of that id."""
        return self._records.get(recording)

    def path(self, recording: StoredRecording) -> Path:
        """Its file."""
        return self._records.place(recording.id) / recording.file

    def intact(self, recording: str) -> bool:
        """Whether one is there and its content is still the one that was sent."""
        try:
            with self.path(self.get(recording)).open("rb") as content:
                return file_digest(content, "sha256").hexdigest() == recording
        except (NotFound, OSError):
            return False

    @contextmanager
    def draft(self) -> Iterator[Path]:
        """Make a folder for a file that is not known to be a recording yet.

        It is gone afterwards, unless it was kept.

        Raises
        ------
        Refused
            The disk is full or cannot be written.
        """
        with writing(self._folder):
            self._folder.mkdir(parents=True, exist_ok=True)
            place = Path(mkdtemp(prefix=DRAFT, dir=self._folder))
        try:
            yield place
        finally:
            rmtree(place, ignore_errors=True)

    def keep(self, draft: Path, recording: StoredRecording) -> bool:
        """Keep the file of a draft; False where the same content is kept already.

        What was kept and was damaged since is mended by it.

        Raises
        ------
        Refused
            The disk is full or cannot be written.
        """
        place = self._records.place(recording.id)
        if self.intact(recording.id):
            return False
        with writing(self._folder):
            with (draft / recording.file).open("rb") as content:
                os.fsync(content.fileno())
            place.mkdir(exist_ok=True)
            (draft / recording.file).rename(place / recording.file)
        # The record comes last: what has none is no recording.
        self._records.put(recording.id, recording)
        return True

    def sweep(self) -> None:
        """Remove the drafts that an interrupted service left."""
        for left in self._folder.glob(f"{DRAFT}*"):
            rmtree(left, ignore_errors=True)
