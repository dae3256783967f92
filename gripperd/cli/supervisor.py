"""Starts the processes of ``gripperd run`` in order, and again when one dies or stalls.

The grip does not depend on this process, nor on the service: the output module keeps
the last current, and a control process that starts anew adopts it.
"""

import asyncio
import os
import signal
import socket
import sys
from asyncio.subprocess import Process
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from itertools import repeat
from pathlib import Path

import structlog

from gripperd.cli.notify import VARIABLE, listen, parse
from gripperd.cli.watchdog import INTERVAL, OWNER
from gripperd.errors import GripperdError

READY_WITHIN = 60.0
"""Longest time for a process to become ready, as for the units of systemd: a start
takes 2 s of processor, and a busy machine is slow to give them. [s]"""
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
    silence: float | None = None
    """After this time without a sign of life it is killed; None is never. [s]"""
    alive: Callable[[], None] = lambda: None
    """Called on every sign of life, and on every attempt at a new one."""
    process: Process | None = None
    facts: Mapping[str, str] = field(default_factory=dict)
    """What it reported when it became ready."""
    _receiver: socket.socket | None = None

    async def start(self) -> None:
        """Start it and wait until it is ready.

        Raises
        ------
        StartFailed
            It ended first, or took too long.
        ConfigError
            It cannot report.
        """
        self.alive()
        self._close()
        self._receiver = listen(self._address)
        self.process = await asyncio.create_subprocess_exec(
            sys.executable,
            "-m",
            "gripperd",
            *self.arguments,
            env=self._environment(),
            start_new_session=True,
        )
        self.facts = await self._ready(self._receiver)

    @property
    def _address(self) -> Path:
        return self.folder / f"{self.name}.notify"

    def _environment(self) -> dict[str, str]:
        ours = {VARIABLE: str(self._address), SUPERVISED: str(os.getpid())}
        if self.silence is not None:
            ours[INTERVAL] = str(round(self.silence * 1e6))
        # Who watches this process does not watch its children.
        others = {INTERVAL, OWNER}
        return {k: v for k, v in os.environ.items() if k not in others} | ours

    def _close(self) -> None:
        if self._receiver is not None:
            self._receiver.close()
            self._receiver = None
            self._address.unlink(missing_ok=True)

    async def _ready(self, receiver: socket.socket) -> Mapping[str, str]:
        assert self.process is not None
        report = asyncio.create_task(_readiness(receiver))
        death = asyncio.create_task(self.process.wait())
        done, pending = await asyncio.wait(
            {report, death},
            timeout=READY_WITHIN,
            return_when=asyncio.FIRST_COMPLETED,
        )
        for task in pending:
            task.cancel()
        if report in done:
            return report.result()
        if death in done:
            message = f"{self.name} ended at its start with status {death.result()}"
            raise StartFailed(message, death.result())
        await self.end()
        message = f"{self.name} was not ready within {READY_WITHIN:g} s"
        raise StartFailed(message, 1)

    async def died(self) -> int:
        """Status once it has ended; a stalled one is made to."""
        assert self.process is not None
        watch = asyncio.create_task(self._watch())
        try:
            return await self.process.wait()
        finally:
            watch.cancel()

    async def _watch(self) -> None:
        """Wait for signs of life, and kill it when there are none."""
        assert self.process is not None
        while await self._sign():
            self.alive()
        log.error("process is stalled", process=self.name, silent_s=self.silence)
        with suppress(ProcessLookupError):
            self.process.kill()

    async def _sign(self) -> bool:
        """Whether it gives a sign of life in time."""
        receiver = self._receiver
        assert receiver is not None
        try:
            async with asyncio.timeout(self.silence):
                await asyncio.get_running_loop().sock_recv(receiver, 4096)
        except TimeoutError:
            # If it was this process that stalled, the signs have piled up.
            with suppress(BlockingIOError):
                return bool(receiver.recv(4096))
            return False
        return True

    async def end(self) -> None:
        """Ask it to end, and insist; it may report until then."""
        await self._end()
        self._close()

    async def _end(self) -> None:
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


async def _readiness(receiver: socket.socket) -> Mapping[str, str]:
    """What a process reports when it is ready; signs of life may come before."""
    loop = asyncio.get_running_loop()
    while "READY" not in (facts := parse(await loop.sock_recv(receiver, 4096))):
        pass
    return facts


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
        log.error("process ended", process=child.name, how=_how(status))
        await _revive(child)


def _how(status: int) -> str:
    """How a process ended, by its status."""
    if status < 0:
        return f"killed by {signal.Signals(-status).name}"
    return f"exit status {status}"


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
