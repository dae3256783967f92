"""What a diagnosis named, kept as a new version of the model that it judged."""

from dataclasses import replace
from datetime import datetime
from pathlib import Path

from gripperd.config import ModelFile, Settings, model_text
from gripperd.errors import NotFound, Refused
from gripperd.store.active import versions_of
from gripperd.store.diagnoses import MODEL, Diagnoses, StoredDiagnosis, read_improvement
from gripperd.store.version import Version


def accept(
    diagnosis: StoredDiagnosis, kept: Diagnoses, settings: Settings, now: datetime
) -> Version:
    """Keep the better model of a diagnosis that has succeeded; none becomes active.

    Parameters
    ----------
    diagnosis
        What was found.
    kept
        Where it is written down.
    settings
        As they were loaded.
    now
        The time of day, with its zone.

    Raises
    ------
    NotFound
        The gripper or the version that was judged is not there any more.
    Refused
        Nothing was named or confirmed, it was accepted before, or the model that was
        judged is not as it was.
    ConfigError
        A file of the diagnosis or of the versions is damaged.
    """
    if diagnosis.kept_as is not None:
        message = f"it was kept already, as {diagnosis.kept_as}"
        raise Refused(message, code="already-accepted")
    if diagnosis.objection is not None:
        raise Refused(diagnosis.objection.message, code=diagnosis.objection.code)
    if diagnosis.gripper not in settings.grippers:
        message = f"there is no gripper {diagnosis.gripper!r} any more"
        raise NotFound(message, key="id")
    place = kept.place(diagnosis.id)
    versions = versions_of(settings, settings.grippers[diagnosis.gripper])
    judged = versions.get(diagnosis.version).model
    if not _is(judged, place / MODEL):
        message = f"{diagnosis.model} is not the model any more that was judged"
        hints = ("diagnose the recording again",)
        raise Refused(message, code="model-changed", hints=hints)
    model, made = read_improvement(place)
    version = versions.add(
        model, parent=diagnosis.version, created_at=now, provenance=made, once=True
    )
    kept.put(replace(diagnosis, kept_as=version.name))
    return version


def _is(model: ModelFile, file: Path) -> bool:
    try:
        return file.read_bytes() == model_text(model).encode()
    except OSError:
        return False
