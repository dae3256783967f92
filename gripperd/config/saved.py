"""Profiles that users saved through the service: a folder of files like the shipped."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from gripperd.config.complaint import Complaint
from gripperd.config.durable import remove_file, replace_file
from gripperd.config.profile import profile_document, readable_profiles
from gripperd.config.text import yaml_text
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
    replace_file(_file(profile.name, folder), yaml_text(profile_document(profile)))


def delete_profile(name: str, folder: Path) -> None:
    """Remove a saved profile, if somebody else has not done so.

    Raises
    ------
    OSError
        It is still there.
    """
    remove_file(_file(name, folder))


def _file(name: str, folder: Path) -> Path:
    return folder / f"{name}.yaml"
