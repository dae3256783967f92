"""Profiles that users saved through the service: a folder of files like the shipped."""

import os
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import yaml

from gripperd.config.complaint import Complaint
from gripperd.config.profile import profile_document, readable_profiles
from gripperd.control.profile import Profile


@dataclass(frozen=True, slots=True)
class SavedProfiles:
    """What users saved, as far as it can be read."""

    profiles: Mapping[str, Profile]
    complaints: tuple[str, ...]
    """What is wrong with the files that were skipped."""


def saved_profiles(folder: Path) -> SavedProfiles:
    """Every saved profile; none where nothing was ever saved.

    One broken file costs one profile, and never the daemon its start.
    """
    complaints: list[str] = []
    profiles: Mapping[str, Profile] = {}
    try:
        if folder.is_dir():
            profiles = readable_profiles(folder, complaints)
    except OSError as error:
        detail = f"cannot be read: {error.strerror}"
        complaints.append(Complaint(detail, source=str(folder)))
    return SavedProfiles(profiles, tuple(complaints))


def write_profile(profile: Profile, folder: Path) -> None:
    """Save a profile; after a power cut there is the old one or the new, never half.

    Raises
    ------
    OSError
        It was not saved; the old one is still there.
    """
    folder.mkdir(parents=True, exist_ok=True)
    text = yaml.safe_dump(
        profile_document(profile), sort_keys=False, allow_unicode=True
    )
    draft = folder / f".{profile.name}.draft"
    try:
        with draft.open("w", encoding="utf-8") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        draft.replace(_file(profile.name, folder))
    except OSError:
        with suppress(OSError):
            draft.unlink()
        raise
    _settle(folder)


def delete_profile(name: str, folder: Path) -> None:
    """Remove a saved profile, if somebody else has not done so.

    Raises
    ------
    OSError
        It is still there.
    """
    _file(name, folder).unlink(missing_ok=True)
    _settle(folder)


def _file(name: str, folder: Path) -> Path:
    return folder / f"{name}.yaml"


def _settle(folder: Path) -> None:
    """Make what happened to the names in a folder outlast a power cut."""
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
