"""Keeps what was tared, so that the next control process goes on with it."""

import time
from functools import partial
from pathlib import Path

import structlog

from gripperd.cli.keeping import keep
from gripperd.config import GripperSettings
from gripperd.config.zero_file import keep_zero, kept_zero
from gripperd.control.gripper import Gripper
from gripperd.control.journal import Happening
from gripperd.control.loop import Loop

NOT_KEPT = "the zero of the force sensor ends with this process"

log = structlog.get_logger()


def adopt_zero(folder: Path, settings: GripperSettings, gripper: Gripper) -> None:
    """Go by the zero that an earlier life kept, and say so."""
    now = time.time()
    kept = kept_zero(folder, settings, now)
    gripper.zero = kept.zero
    if kept.remark is not None:
        log.warning(kept.remark, gripper=gripper.name)
        gripper.ledger.journal.note(Happening.ADOPTION, kept.remark, now)


async def keep_zeros(folder: Path, settings: GripperSettings, loop: Loop) -> None:
    """Write down every new zero, for ever."""
    write = partial(keep_zero, folder, settings)
    await keep(loop, lambda: loop.gripper.zero, write, NOT_KEPT)
