"""Writes down what the next control process has to know."""

import asyncio
from collections.abc import Callable
from typing import TypeVar

import structlog

from gripperd.control.loop import Loop

T = TypeVar("T")

LOOK = 60.0
"""Longest time between two looks, and until a disk that failed is tried again; news
end it before. [s]"""

log = structlog.get_logger()


async def keep(
    loop: Loop, present: Callable[[], T], write: Callable[[T], None], without: str
) -> None:
    """Write down every new value, for ever; the loop does not wait for the disk.

    Parameters
    ----------
    loop
        Whose journal tells that there may be a new one.
    present
        Gives the value; the first is known already.
    write
        Puts it on the disk, or raises `OSError`.
    without
        What it means when that fails.
    """
    kept, seen = present(), 0
    while True:
        seen = (await loop.follow(seen, LOOK)).newest
        if (value := present()) == kept:
            continue
        try:
            await asyncio.to_thread(write, value)
            kept = value
        except OSError as error:
            log.error(without, gripper=loop.gripper.name, cause=str(error))
