"""What a section of the settings file may look at besides itself."""

from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from pydantic import ValidationInfo

from gripperd.config.module_library import ModuleLibrary
from gripperd.config.wording import shown


@dataclass(frozen=True, slots=True)
class Surroundings:
    """The context of a validation."""

    folder: Path
    """Of the file; what it names is relative to it."""
    modules: ModuleLibrary


def library(asked: ValidationInfo) -> ModuleLibrary:
    """Modules that can be named; the shipped where a section stands alone."""
    around = asked.context
    return around.modules if isinstance(around, Surroundings) else ModuleLibrary()


def path_of(name: object, asked: ValidationInfo) -> Path:
    """Path of a file or folder that the settings name, relative to their own.

    Raises
    ------
    ValueError
        There is none.
    """
    around = asked.context
    here = around.folder if isinstance(around, Surroundings) else Path()
    # The name may be too long, or lead where this user may not look.
    with suppress(OSError):
        if isinstance(name, str) and (here / name).exists():
            return here / name
    message = f"{shown(name)} cannot be found from {here}"
    raise ValueError(message)
