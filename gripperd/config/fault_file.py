"""Latched faults, kept in the state directory until somebody has reset them."""

from collections.abc import Sequence
from pathlib import Path

import msgspec

from gripperd.config.durable import replace_file
from gripperd.control.fault import Fault
from gripperd.errors import ConfigError

FOLDER = "faults"
"""In the state directory."""


def kept_faults(folder: Path, gripper: str) -> tuple[Fault, ...]:
    """Read the latched faults that an earlier life left, oldest first.

    Parameters
    ----------
    folder
        The state directory.
    gripper
        Whose faults they are.

    Raises
    ------
    ConfigError
        The file cannot be read.
    """
    path = _file(folder, gripper)
    try:
        return msgspec.json.decode(path.read_bytes(), type=tuple[Fault, ...])
    except FileNotFoundError:
        return ()
    except OSError as error:
        message = f"{path}: cannot be read: {error.strerror}"
        raise ConfigError(message) from error
    except (msgspec.DecodeError, UnicodeDecodeError) as error:
        message = f"{path}: is not as it was written: {error}"
        raise ConfigError(message) from error


def keep_faults(folder: Path, gripper: str, latched: Sequence[Fault]) -> None:
    """Keep the latched faults for the next life, in place of those kept before.

    Raises
    ------
    OSError
        They were not kept.
    """
    text = msgspec.json.format(msgspec.json.encode(latched)).decode()
    replace_file(_file(folder, gripper), text)


def _file(folder: Path, gripper: str) -> Path:
    return folder / FOLDER / f"{gripper}.json"
