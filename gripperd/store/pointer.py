"""Which version is active, which ones were before it, and how many there were."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace
from fcntl import LOCK_EX, flock
from pathlib import Path
from typing import Annotated

from pydantic import Field

from gripperd.config import Complaint
from gripperd.config.document import read_document
from gripperd.config.durable import replace_file
from gripperd.config.section import Section
from gripperd.config.text import yaml_text
from gripperd.config.validation import validated
from gripperd.errors import ConfigError, Refused

Number = Annotated[int, Field(ge=0)]


class PointerSection(Section):
    """The file."""

    active: Number
    before: Annotated[tuple[Number, ...], Field(strict=False)] = ()
    made: Number = 0


@dataclass(frozen=True, slots=True)
class Pointer:
    """The active version; it starts at 0, the configured model."""

    active: int = 0
    before: tuple[int, ...] = ()
    """Those to roll back to, the last one first to come."""
    made: int = 0
    """The highest number that a version ever had: no other gets it."""

    def to(self, version: int) -> "Pointer":
        """Point to another version."""
        if version == self.active:
            return self
        return replace(self, active=version, before=(*self.before, self.active))

    def back(self) -> "Pointer":
        """Point to the version that was active before.

        Raises
        ------
        Refused
            There was none.
        """
        if not self.before:
            message = f"version {self.active} was the first; there is none before it"
            raise Refused(message, code="nothing-before")
        return replace(self, active=self.before[-1], before=self.before[:-1])


def read_pointer(path: Path) -> Pointer:
    """Read which version is active; 0 where none ever was activated.

    Raises
    ------
    ConfigError
        The file is damaged; nobody can say which one is active.
    """
    if not path.exists():
        return Pointer()
    try:
        section = validated(PointerSection, read_document(path))
    except ConfigError as damaged:
        hint = "nobody can say which version is active; remove the file for version 0"
        complaint = Complaint(hint, source=str(path))
        raise ConfigError(*damaged.complaints, complaint) from None
    return Pointer(section.active, section.before, section.made)


def write_pointer(pointer: Pointer, path: Path) -> None:
    """Write down which version is active.

    Raises
    ------
    OSError
        What was written before still holds.
    """
    document = asdict(pointer) | {"before": list(pointer.before)}
    replace_file(path, yaml_text(document))


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Be the only one who changes a folder, among processes and threads."""
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / ".lock").open("w") as lock:
        flock(lock, LOCK_EX)
        yield
