"""Keeps latched faults, so that no new control process forgets what nobody has seen."""

import time
from functools import partial
from pathlib import Path

import structlog

from gripperd.cli.keeping import keep
from gripperd.config.fault_file import keep_faults, kept_faults
from gripperd.control.gripper import Gripper
from gripperd.control.journal import Happening
from gripperd.control.loop import Loop
from gripperd.errors import ConfigError

NOT_KEPT = "latched faults end with this process"

log = structlog.get_logger()


def adopt_faults(folder: Path, gripper: Gripper) -> None:
    """Go on with the faults that an earlier life left latched, and say so."""
    try:
        found = kept_faults(folder, gripper.name)
    except ConfigError as error:
        _say(f"it is not known what was latched: {error}", gripper)
        return
    gripper.faults.adopt(found)
    for fault in found:
        _say(f"adopted a latched fault: {fault.cause}: {fault.message}", gripper)


async def keep_latched(folder: Path, loop: Loop) -> None:
    """Write down what is latched whenever that changes, for ever."""
    faults = loop.gripper.faults
    write = partial(keep_faults, folder, loop.gripper.name)
    await keep(loop, lambda: faults.latched, write, NOT_KEPT)


def _say(text: str, gripper: Gripper) -> None:
    log.warning(text, gripper=gripper.name)
    gripper.ledger.journal.note(Happening.ADOPTION, text, time.time())
