"""Folders with a record each: one JSON file, and what belongs to it."""

import errno
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Generic, TypeVar

import msgspec

from gripperd.config.durable import replace_file
from gripperd.errors import NotFound, Refused

T = TypeVar("T")

FILE = "record.json"
ID = re.compile(r"[0-9a-f]{32,64}")
"""An id is the name of a folder, so it is nothing else."""
FULL = frozenset({errno.ENOSPC, errno.EDQUOT})
"""What an operating system says when there is no room left."""


class Records(Generic[T]):
    """Records of one kind, each in a folder that is named after its id.

    Parameters
    ----------
    folder
        Where the folders are.
    kind
        A dataclass that says everything about one.
    noun
        What one is called, for messages.
    """

    def __init__(self, folder: Path, kind: type[T], noun: str) -> None:
        self.folder = folder
        self._kind = kind
        self._noun = noun

    def place(self, record: str) -> Path:
        """Folder of a record, for what belongs to it.

        Raises
        ------
        NotFound
            It is no id.
        """
        if not ID.fullmatch(record):
            raise self._missing(record)
        return self.folder / record

    def get(self, record: str) -> T:
        """One record.

        Raises
        ------
        NotFound
            There is none of that id, or its file is damaged.
        """
        try:
            content = (self.place(record) / FILE).read_bytes()
            return msgspec.json.decode(content, type=self._kind)
        except (OSError, msgspec.DecodeError) as error:
            raise self._missing(record) from error

    def put(self, record: str, content: T) -> None:
        """Write a record, in place of the one of that id.

        Raises
        ------
        Refused
            The disk is full or cannot be written; nothing was changed.
        """
        with writing(self.folder):
            text = msgspec.json.format(msgspec.json.encode(content)).decode()
            replace_file(self.place(record) / FILE, f"{text}\n")

    def all(self) -> Iterator[T]:
        """Every record that can be read."""
        for file in self.folder.glob(f"*/{FILE}"):
            if ID.fullmatch(file.parent.name):
                try:
                    yield self.get(file.parent.name)
                except NotFound:
                    continue

    def _missing(self, record: str) -> NotFound:
        message = f"there is no {self._noun} {record[:80]!r}"
        return NotFound(message, key="id")


@contextmanager
def writing(folder: Path) -> Iterator[None]:
    """Let what the disk refuses inside be refused in our words."""
    try:
        yield
    except OSError as error:
        code = "storage-full" if error.errno in FULL else "storage-failed"
        message = f"{folder}: nothing was kept: {error.strerror}"
        raise Refused(message, code=code) from error
