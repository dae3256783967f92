"""Directories of the daemon, where the settings leave them open."""

import os
import tempfile
from collections.abc import Mapping
from pathlib import Path


def runtime_dir(named: str | None, folder: Path, environ: Mapping[str, str]) -> Path:
    """Where sockets live: what the settings name, or systemd, or the system."""
    if named is not None:
        return folder / named
    given = _first(environ, "RUNTIME_DIRECTORY")
    return Path(given or Path(tempfile.gettempdir(), f"gripperd-{os.getuid()}"))


def state_dir(named: str | None, folder: Path, environ: Mapping[str, str]) -> Path:
    """Where what users save lives, likewise."""
    if named is not None:
        return folder / named
    home = environ.get("XDG_STATE_HOME") or Path("~/.local/state").expanduser()
    return Path(_first(environ, "STATE_DIRECTORY") or Path(home, "gripperd"))


def _first(environ: Mapping[str, str], variable: str) -> str:
    """The unit's own directory: systemd lists several with colons."""
    return environ.get(variable, "").partition(":")[0]
