"""Starts the processes of ``gripperd run`` in order, and again when one dies.

The grip does not depend on this process, nor on the service: the output module keeps
the last current, and a control process that starts anew adopts it.
"""

import asyncio
import os
import signal
import socket
import sys
from asyncio.subprocess import Process
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from itertools import repeat
from pathlib import Path

import structlog

from gripperd.cli.notify import VARIABLE, listen, parse
from gripperd.errors import GripperdError

READY_WITHIN = 30.0
"""Longest time for a process to become ready. [s]"""
GRACE = 5.0
"""Time for a process to end by itself before it is killed. [s]"""
FIRST_PAUSE, LONGEST_PAUSE = 1.0, 10.0
"""Between the death of a process and its next life. [s]"""

SUPERVISED = "GRIPPERD_SUPERVISED"
"""Variable that tells a process the id of its supervisor."""

log = structlog.get_logger()


class StartFailed(GripperdError):
    """A process did not become ready."""

    def __init__(self, message: str, status: int) -> None:
        super().__init__(message)
        self.status = status


@dataclass(slots=True)
class Child:
    """One process of the program."""

    name: str
    arguments: list[str]
    folder: Path
    """Where its readiness socket lives."""
    process: Process | None = None
    facts: Mapping[str, str] = field(default_factory=dict)
    """What it reported when it became ready."""

    async def start(self) -> None:
        """Start it and wait until it is ready.

        Raises
        ------
        StartFailed
            It ended first, or took too long.
        ConfigError
            It cannot report.
        """
        address = self.folder / f"{self.name}.notify"
        receiver = listen(address)
        try:
            self.process = await asyncio.create_subprocess_exec(
                sys.executable,
                "-m",
                "gripperd",
                *self.arguments,
                env=os.environ | {VARIABLE: str(address), SUPERVISED: str(os.getpid())},
                start_new_session=True,
            )
            self.facts = await self._ready(receiver)
        finally:
            receiver.close()
            address.unlink(missing_ok=True)

    async def _ready(self, receiver: socket.socket) -> Mapping[str, str]:
        assert self.process is not None
        loop = asyncio.get_running_loop()
        report = asyncio.create_task(loop.sock_recv(receiver, 4096))
        death = asyncio.create_task(self.process.wait())
        done, pending = await asyncio.wait(
            {report, death},
            timeout=READY_WITHIN,
            return_when=asyncio.FIRST_COMPLETED,
        )
        for task in pending:
            task.cancel()
        if report in done:
            return parse(report.result())
        if death in done:
            message = f"{self.name} ended at its start with status {death.result()}"
            raise StartFailed(message, death.result())
        await self.end()
        message = f"{self.name} was not ready within {READY_WITHIN:g} s"
        raise StartFailed(message, 1)

    async def died(self) -> int:
        """Status once it has ended."""
        assert self.process is not None
        return await self.process.wait()

    async def end(self) -> None:
        """Ask it to end, and insist."""
        if self.process is None or self.process.returncode is not None:
            return
        with suppress(ProcessLookupError):
            self.process.terminate()
            try:
                async with asyncio.timeout(GRACE):
                    await self.process.wait()
            except TimeoutError:
                log.warning("killed", process=self.name)
                self.process.kill()
                await self.process.wait()


async def supervise(children: list[Child]) -> None:
    """Keep every child alive, for ever.

    All were ready once. Whatever one of them finds wrong from then on, be it a file
    that was changed meanwhile, the others go on, and it is tried again.
    """
    async with asyncio.TaskGroup() as tasks:
        for child in children:
            tasks.create_task(_keep(child))


async def _keep(child: Child) -> None:
    while True:
        status = await child.died()
        log.error("process ended", process=child.name, status=status)
        await _revive(child)


async def _revive(child: Child) -> None:
    for pause in pauses():
        await asyncio.sleep(pause)
        try:
            await child.start()
        except (GripperdError, OSError) as error:
            log.error("process does not start", process=child.name, cause=str(error))
        else:
            log.warning("process restarted", process=child.name)
            return


def pauses() -> Iterator[float]:
    """How long to wait before each attempt to start a process again. [s]."""
    pause = FIRST_PAUSE
    while pause < LONGEST_PAUSE:
        yield pause
        pause *= 2
    yield from repeat(LONGEST_PAUSE)


async def stop_requested() -> str:
    """Name of the signal that asks this process to end."""
    loop = asyncio.get_running_loop()
    received: asyncio.Future[str] = loop.create_future()

    def receive(name: str) -> None:
        if not received.done():
            received.set_result(name)

    for number in (signal.SIGTERM, signal.SIGINT):
        loop.add_signal_handler(number, receive, number.name)
    return await received
