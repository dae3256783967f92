"""What a section of the settings file may look at besides itself."""

from dataclasses import dataclass
from pathlib import Path

from pydantic import ValidationInfo

from gripperd.config.module_library import ModuleLibrary


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


def folder_of(asked: ValidationInfo) -> Path:
    """Folder of the file."""
    around = asked.context
    return around.folder if isinstance(around, Surroundings) else Path()
