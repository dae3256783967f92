"""A worker process, and the messages that it prints: a line of JSON each."""

import asyncio
import os
import sys
from asyncio.subprocess import PIPE, Process
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import TypeAlias, TypeVar

import msgspec
import structlog

from gripperd.errors import GripperdError
from gripperd.link.frames import Failed, raised
from gripperd.store.diagnoses import Why
from gripperd.store.recordings import Contents

T = TypeVar("T", bound=msgspec.Struct)

WORKER = "gripperd.service.worker"
LONGEST_LINE = 1 << 24
"""A recording of very many runs is told in one line. [octets]"""

log = structlog.get_logger()


class Progress(msgspec.Struct, frozen=True, tag=True):
    """What is being done, and the share that is done, 0 to 1."""

    what: str
    share: float


class Read(msgspec.Struct, frozen=True, tag=True):
    """A recording was read."""

    contents: Contents


class Judged(msgspec.Struct, frozen=True, tag=True):
    """A diagnosis is over."""

    verdict: str
    objection: Why | None
    """Why there is nothing to accept."""
    unprinted: str | None
    """Why there is no report."""


class Broken(msgspec.Struct, frozen=True, tag=True):
    """The job could not be done."""

    failed: Failed


Message: TypeAlias = Progress | Read | Judged | Broken


def say(message: Message) -> None:
    """Print a message, as the worker does."""
    # Past the buffer: what is left in one would be tried again when all is over.
    os.write(sys.stdout.fileno(), msgspec.json.encode(message) + b"\n")


async def work(
    *arguments: str,
    reply: type[T],
    folder: Path,
    tell: Callable[[Progress], None] = lambda _: None,
) -> T:
    """Let a worker do a job; it ends with whoever waits for it.

    Parameters
    ----------
    arguments
        The job, see :mod:`gripperd.service.worker`.
    reply
        Message that ends it well.
    folder
        Where it runs, so that names of files are as short as a client knows them.
    tell
        Told how far it is.

    Raises
    ------
    GripperdError
        Whatever the worker raised; or it came to a bad end.
    """
    # -P: nothing in the folder is taken for a module.
    command = (sys.executable, "-P", "-m", WORKER, *arguments)
    process = await asyncio.create_subprocess_exec(
        *command, stdout=PIPE, cwd=folder, limit=LONGEST_LINE
    )
    try:
        return await _last(process, reply, tell)
    finally:
        with suppress(ProcessLookupError):
            process.kill()
        await process.wait()


async def _last(
    process: Process, reply: type[T], tell: Callable[[Progress], None]
) -> T:
    assert process.stdout is not None
    async for line in process.stdout:
        message = _message(line)
        if isinstance(message, Broken):
            raise raised(message.failed)
        if isinstance(message, reply):
            return message
        if isinstance(message, Progress):
            tell(message)
    status = await process.wait()
    log.error("a worker came to a bad end", status=status)
    detail = f"the worker process came to a bad end, status {status}"
    raise GripperdError(detail)


def _message(line: bytes) -> Message | None:
    """What a line says; nothing, when it was cut off or some library printed it."""
    with suppress(msgspec.DecodeError):
        message: Message = msgspec.json.decode(line, type=Message)
        return message
    return None
