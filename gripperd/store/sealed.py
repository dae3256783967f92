"""Text that says in its last line what it was when it was written."""

import hashlib
from pathlib import Path

from gripperd.config import Complaint
from gripperd.errors import ConfigError

SEAL = "# sha256: "
"""A comment, so that a sealed model file is a model file."""


def sealed(text: str) -> str:
    """Add the digest (FIPS 180-4, SHA-256) of all lines before it."""
    return f"{text}{SEAL}{hashlib.sha256(text.encode()).hexdigest()}\n"


def check_seal(path: Path) -> None:
    """Refuse a file that is not as it was written.

    Raises
    ------
    ConfigError
        A line is missing, or a character is another.
    """
    try:
        content = path.read_bytes()
    except OSError as error:
        detail = f"cannot be read: {error.strerror}"
        raise ConfigError(Complaint(detail, source=str(path))) from error
    text, seal, said = content.rpartition(SEAL.encode())
    if not seal or said != hashlib.sha256(text).hexdigest().encode() + b"\n":
        detail = "is not as it was written: the sha256 in its last line does not match"
        raise ConfigError(Complaint(detail, source=str(path)))
