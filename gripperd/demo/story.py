"""From a model that is wrong to one that is not, step by step."""

import json
import os
from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from gripperd.config import ModelFile, load_model
from gripperd.demo.files import STEP, write_rig
from gripperd.demo.hidden import Hidden
from gripperd.diagnose.diagnosis import Diagnosis, diagnose
from gripperd.diagnose.document import document
from gripperd.effects import EFFECTS
from gripperd.errors import InputError, Refused
from gripperd.recordings import read_recording
from gripperd.report import page
from gripperd.store import Version, Versions
from gripperd.store.improvement import improvement


@dataclass(frozen=True, slots=True)
class Story:
    """What happened, and where it was written."""

    diagnosis: Diagnosis
    better: Version | None
    """The model with what was named; none when nothing was."""
    report: Path


def demonstrate(  # noqa: PLR0913  (what, where, when)
    folder: Path,
    hidden: Hidden,
    seed: int,
    *,
    program: str,
    now: datetime,
    progress: Callable[[str, float], None],
    step: float = STEP,
) -> Story:
    """Hide an effect in a rig, find it, add it and write the report.

    Parameters
    ----------
    folder
        Where everything is written.
    hidden
        What the rig does and the model does not know of.
    seed
        Of every random draw.
    program
        Version of the program.
    now
        When the better model was made.
    progress
        Told how far it is.
    step
        Time between samples of the recording. [s]

    Raises
    ------
    InputError
        The folder cannot be written or holds files of somebody's own, or the extra
        ``report`` is not installed.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        write_rig(folder, hidden, seed, step)
        model = load_model(folder / "model.yaml")
        found = diagnose(
            read_recording(folder / "rig.csv"),
            model.explanation(),
            model.tolerances,
            EFFECTS,
            seed,
            progress,
            len(os.sched_getaffinity(0)),
        )
        report = folder / "report.html"
        text = page(found, model=model.name, program=program)
        report.write_text(text, encoding="utf-8")
        told = document(found, model=model.name, program=program)
        (folder / "diagnosis.json").write_text(json.dumps(told, indent=2) + "\n")
    except OSError as refusal:
        message = f"{folder}: cannot be written: {refusal.strerror}"
        raise InputError(message, key="--out") from refusal
    return Story(found, _better(folder, model, found, program, now), report)


def _better(
    folder: Path, model: ModelFile, found: Diagnosis, program: str, now: datetime
) -> Version | None:
    try:
        better = improvement(model, found, program)
    except Refused:
        return None
    return Versions(folder / "versions", model).add(
        better.model, parent=0, created_at=now, provenance=better.provenance
    )
