"""The folder of the sockets between the processes: the user's, and nobody else's.

Its default lies under the system's temporary directory, where any user may have put
something by that name before: a link, or a folder to listen in.
"""

import os
from pathlib import Path

from gripperd.errors import ConfigError

LONGEST_ADDRESS = 107
"""What a Unix socket's path may have, without its final zero (unix(7)). [octets]"""
OTHERS = 0o077
"""What group and others may do."""


def private_folder(folder: Path, *sockets: str) -> None:
    """Make a folder that only this user can enter, or see that it is one.

    Parameters
    ----------
    folder
        Where the sockets live.
    sockets
        Their names.

    Raises
    ------
    ConfigError
        It is no directory of this user's, or too long for the name of a socket.
    """
    longest = max(len(os.fsencode(folder / name)) for name in sockets)
    if longest > LONGEST_ADDRESS:
        raise _unusable(
            folder,
            f"is too long: the path of a socket in it would have {longest} octets, at"
            f" most {LONGEST_ADDRESS} are possible",
        )
    try:
        folder.mkdir(parents=True, exist_ok=True, mode=0o700)
        # Everything below goes by what was opened, whatever the name means by then.
        opened = os.open(folder, os.O_DIRECTORY | os.O_NOFOLLOW | os.O_CLOEXEC)
    except (FileExistsError, NotADirectoryError):
        raise _unusable(folder, "is not a directory; nor is a link to one") from None
    except OSError as error:
        raise _unusable(folder, f"cannot be used: {error.strerror}") from error
    try:
        _close_to_others(folder, opened)
    finally:
        os.close(opened)


def _close_to_others(folder: Path, opened: int) -> None:
    found = os.fstat(opened)
    if found.st_uid != os.geteuid():
        detail = f"belongs to user {found.st_uid}, not to {os.geteuid()}"
        raise _unusable(folder, detail)
    if found.st_mode & OTHERS:
        os.fchmod(opened, 0o700)


def _unusable(folder: Path, detail: str) -> ConfigError:
    return ConfigError(f"runtime_dir {folder} {detail}")
