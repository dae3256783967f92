"""One version of a model, and all that can be read."""

from dataclasses import dataclass

from gripperd.config import ModelFile


@dataclass(frozen=True, slots=True)
class Version:
    """One version of a model."""

    number: int
    """0: the configured model."""
    model: ModelFile
    """The model, named after its version; its lineage is None for version 0."""

    @property
    def name(self) -> str:
        """Name of the model, such as ``reference-3``."""
        return self.model.name


@dataclass(frozen=True, slots=True)
class Shelf:
    """Every version that can be read."""

    versions: tuple[Version, ...]
    """From 0 up."""
    active: int
    complaints: tuple[str, ...]
    """What is wrong with those that cannot be read."""
