"""Text that says in its last line what it was when it was written."""

import hashlib
from pathlib import Path

from gripperd.config.complaint import Complaint
from gripperd.errors import ConfigError

SEAL = "# sha256: "
"""A comment, so that a sealed model file is a model file."""


def sealed(text: str) -> str:
    """Add the digest (FIPS 180-4, SHA-256) of all lines before it."""
    return f"{text}{SEAL}{hashlib.sha256(text.encode()).hexdigest()}\n"


def check_seal(path: Path, *, needed: bool = True) -> None:
    """Refuse a file that is not as it was written.

    Parameters
    ----------
    path
        The file.
    needed
        Whether to refuse one without a digest, too.

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
    is_line = not text or text.endswith(b"\n")
    if not needed and not (seal and is_line):
        return
    if not seal or said != hashlib.sha256(text).hexdigest().encode() + b"\n":
        detail = "is not as it was written: the sha256 in its last line does not match"
        if not needed:
            detail += "; without that line it is a file of your own"
        raise ConfigError(Complaint(detail, source=str(path)))
