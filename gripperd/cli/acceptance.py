"""What a diagnosis named, kept as a new version, and how to go by it."""

from datetime import UTC, datetime
from pathlib import Path

from gripperd import __version__
from gripperd.cli.parentage import parent_of
from gripperd.config import ModelFile
from gripperd.config.lineage import Added, Gap
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
    known = versions.same(better.model, parent=number, provenance=made)
    word = "kept" if known is None else "already kept"
    now = datetime.now(UTC)
    version = versions.add(
        better.model, parent=number, created_at=now, provenance=made, once=True
    )
    lines = [f"{word} as {version.name}: {version.model.source}"]
    if made.gap is not None:
        lines.append(_gap(made.gap))
    if moved := ", ".join(map(_moved, made.refitted)):
        lines.append(f"with it these constants moved: {moved}")
    return [*lines, parent.way_to(version)]


def _gap(gap: Gap) -> str:
    """Write how far the version is off, which leaves the zeros of the rig out."""
    before, after, floor = (
        f"{size:.3g} {gap.unit}"
        for size in (gap.rmse_before, gap.rmse_after, gap.noise_floor)
    )
    return (
        f"by itself, without zeros and delays of this rig, its {gap.signal} is off by"
        f" {after} on held-out runs instead of {before}, and repeats by {floor}"
    )


def _moved(constant: Added) -> str:
    """Write a constant that was refitted, such as ``muscle.diameter_mm to 20.3``."""
    (value,) = constant.parameters.values()
    return f"{constant.name.removeprefix(WRONG)} to {value:.4g}"
