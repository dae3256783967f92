"""Files that a power cut leaves as they were or as they shall be, never half."""

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path


def replace_file(path: Path, text: str) -> None:
    """Write a file, in place of the one of that name.

    Raises
    ------
    OSError
        It was not written; the old one is still there.
    """
    with _drafted(path, text) as draft:
        draft.replace(path)


def create_file(path: Path, text: str, check: Callable[[Path], object]) -> None:
    """Write a file that is not there yet.

    Parameters
    ----------
    path, text
        Where, and what.
    check
        Reads the file before it gets its name; what it raises, this raises.

    Raises
    ------
    FileExistsError
        There is one of that name; it stays as it is.
    OSError
        It was not written.
    """
    with _drafted(path, text) as draft:
        check(draft)
        # Unlike a rename, a link never takes the place of another file.
        os.link(draft, path)


def remove_file(path: Path) -> None:
    """Remove a file, if somebody else has not done so.

    Raises
    ------
    OSError
        It is still there.
    """
    path.unlink(missing_ok=True)
    _settle(path.parent)


@contextmanager
def _drafted(path: Path, text: str) -> Iterator[Path]:
    """Put a text on the disk under another name, to be given its own inside."""
    path.parent.mkdir(parents=True, exist_ok=True)
    draft = path.with_name(f".{path.stem}.draft")
    try:
        with draft.open("w", encoding="utf-8") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        yield draft
    finally:
        with suppress(OSError):
            draft.unlink()
    _settle(path.parent)


def _settle(folder: Path) -> None:
    """Make what happened to the names in a folder outlast a power cut."""
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
