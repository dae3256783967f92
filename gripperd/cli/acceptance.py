"""What a diagnosis named, kept as a new version, and how to go by it."""

from datetime import UTC, datetime
from pathlib import Path

from gripperd import __version__
from gripperd.cli.parentage import parent_of
from gripperd.config import ModelFile
from gripperd.config.lineage import Added
from gripperd.diagnose.diagnosis import Diagnosis
from gripperd.diagnose.fit.candidates import WRONG
from gripperd.store.improvement import improvement


def accept(found: Diagnosis, model: ModelFile, config: Path | None) -> list[str]:
    """Keep what was named as a version of the model that was judged, once.

    Returns
    -------
    What became of it, a line each.

    Raises
    ------
    Refused
        Nothing was named or confirmed, or another model of that name is configured.
    ConfigError
        The configuration is unusable.
    """
    parent = parent_of(model, config)
    better = improvement(model, found, __version__)
    versions, number, made = parent.versions, parent.number, better.provenance
    version = versions.same(better.model, parent=number, provenance=made)
    word = "kept" if version is None else "already kept"
    if version is None:
        version = versions.add(
            better.model, parent=number, created_at=datetime.now(UTC), provenance=made
        )
    lines = [f"{word} as {version.name}: {version.model.source}"]
    if moved := ", ".join(map(_moved, made.refitted)):
        lines.append(f"with it these constants moved: {moved}")
    return [*lines, parent.way_to(version)]


def _moved(constant: Added) -> str:
    """Write a constant that was refitted, such as ``muscle.diameter_mm to 20.3``."""
    (value,) = constant.parameters.values()
    return f"{constant.name.removeprefix(WRONG)} to {value:.4g}"
