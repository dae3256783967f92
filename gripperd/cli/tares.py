"""Keeps what was tared, so that the next control process goes on with it."""

import asyncio
import time
from pathlib import Path

import structlog

from gripperd.config import GripperSettings
from gripperd.config.zero_file import keep_zero, kept_zero
from gripperd.control.gripper import Gripper
from gripperd.control.journal import Happening
from gripperd.control.loop import Loop
from gripperd.control.zero import Zero

LOOK = 60.0
"""Longest time between two looks; news end it before. [s]"""

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
    """Write down every new zero, for ever; the loop does not wait for the disk."""
    kept, seen = loop.gripper.zero, 0
    while True:
        journal = await loop.follow(seen, LOOK)
        seen = journal.newest
        if (zero := loop.gripper.zero) != kept:
            await asyncio.to_thread(_keep, folder, settings, zero)
            kept = zero


def _keep(folder: Path, settings: GripperSettings, zero: Zero) -> None:
    try:
        keep_zero(folder, settings, zero)
    except OSError as error:
        log.error(
            "the zero of the force sensor ends with this process",
            gripper=settings.name,
            cause=str(error),
        )
