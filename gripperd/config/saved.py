"""Profiles that users saved through the service: a folder of files like the shipped."""

import os
from collections.abc import Mapping
from pathlib import Path

import yaml

from gripperd.config.profile import load_profiles, profile_document
from gripperd.control.profile import Profile


def saved_profiles(folder: Path) -> Mapping[str, Profile]:
    """Every saved profile; none where nothing was ever saved.

    Raises
    ------
    ConfigError
        With everything that is wrong with any of the files.
    """
    return load_profiles(folder) if folder.is_dir() else {}


def write_profile(profile: Profile, folder: Path) -> None:
    """Save a profile; after a power cut there is the old one or the new, never half."""
    folder.mkdir(parents=True, exist_ok=True)
    text = yaml.safe_dump(
        profile_document(profile), sort_keys=False, allow_unicode=True
    )
    draft = folder / f".{profile.name}.draft"
    with draft.open("w", encoding="utf-8") as file:
        file.write(text)
        file.flush()
        os.fsync(file.fileno())
    draft.replace(_file(profile.name, folder))
    _settle(folder)


def delete_profile(name: str, folder: Path) -> None:
    """Remove a saved profile."""
    _file(name, folder).unlink()
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
