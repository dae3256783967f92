"""The profiles: shipped originals, and what users made of them."""

import asyncio
import errno
import hashlib
from collections.abc import Callable, Mapping
from pathlib import Path

import msgspec

from gripperd.config import (
    SavedProfiles,
    delete_profile,
    saved_profiles,
    write_profile,
)
from gripperd.config.complaint import did_you_mean
from gripperd.control.profile import Profile
from gripperd.errors import NotFound, Refused

FULL = frozenset({errno.ENOSPC, errno.EDQUOT})
"""What an operating system says when there is no room left."""


class ProfileLibrary:
    """Profiles by name; the originals cannot be changed.

    A saved profile has the next version of its name, so that a version says which
    limits a grasp went by. An original takes the place of a saved one of its name.

    Parameters
    ----------
    originals
        What came with the settings.
    folder
        Where users' profiles are kept.
    """

    def __init__(self, originals: Mapping[str, Profile], folder: Path) -> None:
        self.originals = originals
        """Those that cannot be changed here."""
        self.skipped: tuple[str, ...] = ()
        """What is wrong with files of the folder that could not be read."""
        self.changing = asyncio.Lock()
        """To hold from looking at a profile until it is changed."""
        self._folder = folder
        self._own: dict[str, Profile] = {}
        self._versions: dict[str, int] = {}
        self._take(originals, saved_profiles(folder))

    async def renew(self, originals: Mapping[str, Profile]) -> None:
        """Go by other originals, and by what users have saved by now."""
        self._take(originals, await asyncio.to_thread(saved_profiles, self._folder))

    def _take(self, originals: Mapping[str, Profile], saved: SavedProfiles) -> None:
        self.originals = originals
        self.skipped = saved.complaints
        self._own = {
            name: profile
            for name, profile in saved.profiles.items()
            if name not in originals
        }
        self._versions |= {name: own.version for name, own in self._own.items()}

    def all(self) -> list[Profile]:
        """Every profile, the originals first."""
        return [*self.originals.values(), *self._own.values()]

    def get(self, name: str) -> Profile:
        """One profile.

        Raises
        ------
        NotFound
            With the name that was probably meant.
        """
        found = self.originals.get(name) or self._own.get(name)
        if found is None:
            known = [*self.originals, *self._own]
            message = f"there is no profile {name!r}; {did_you_mean(name, known)}"
            raise NotFound(message, key="profile")
        return found

    def read_only(self, name: str) -> bool:
        """Whether it is an original."""
        return name in self.originals

    def __contains__(self, name: str) -> bool:
        """Whether there is a profile of that name."""
        return name in self.originals or name in self._own

    def next_version(self, name: str) -> int:
        """Version that the next saved profile of that name gets."""
        return self._versions.get(name, 0) + 1

    async def save(self, profile: Profile) -> None:
        """Keep a profile, in place of the one of the same name.

        Raises
        ------
        Refused
            The name is that of an original, or the file cannot be written.
        """
        self.check_changeable(profile.name)
        await _on_disk(lambda: write_profile(profile, self._folder))
        self._own[profile.name] = profile
        self._versions[profile.name] = profile.version

    async def remove(self, name: str) -> None:
        """Forget a profile.

        Raises
        ------
        NotFound
            There is none.
        Refused
            It is an original, or the file cannot be removed.
        """
        self.get(name)
        self.check_changeable(name)
        await _on_disk(lambda: delete_profile(name, self._folder))
        del self._own[name]

    def check_changeable(self, name: str) -> None:
        """Refuse to change an original.

        Raises
        ------
        Refused
            It is one.
        """
        if self.read_only(name):
            message = f"the profile {name} came with the settings and stays as it is"
            hints = ("POST /v1/profiles a copy under another name",)
            raise Refused(message, code="read-only", hints=hints)


async def _on_disk(change: Callable[[], None]) -> None:
    """Change a file; a slow disk holds up nobody who wants to stop a gripper."""
    try:
        await asyncio.to_thread(change)
    except OSError as error:
        message = f"nothing was changed: {error.strerror}"
        code = "storage-full" if error.errno in FULL else "storage-failed"
        raise Refused(message, code=code) from error


def tag_of(profile: Profile) -> str:
    """Strong entity tag (RFC 9110, 8.8.3): a digest of everything in it."""
    digest = hashlib.sha256(msgspec.json.encode(profile)).hexdigest()
    return f'"{profile.version}-{digest[:16]}"'
