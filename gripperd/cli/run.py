"""``gripperd run``: every process that the configuration needs, in order."""

import asyncio
import fcntl
import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import uvloop
from rich.console import Console

from gripperd.cli.notify import notify
from gripperd.cli.processes import simulated
from gripperd.cli.supervisor import Child, StartFailed, stop_requested, supervise
from gripperd.cli.watchdog import feed
from gripperd.config import Settings
from gripperd.errors import ConfigError, Refused
from gripperd.link.folder import private_folder

LONGEST_SOCKET = "service.notify"
"""The longest name among the sockets of the processes."""
CONTROL_SILENCE = 2.0
"""A control loop that stands still for so long is started anew: many hundred periods,
and far above the longest pause of a loaded machine. [s]"""
SERVICE_SILENCE = 15.0
"""The service may be busy; nothing that holds depends on it. [s]"""


def run(settings: Settings, console: Console) -> int:
    """Run until a signal ends it; the exit status."""
    private_folder(settings.runtime_dir, LONGEST_SOCKET)
    with _alone(settings.runtime_dir):
        return uvloop.run(_run(settings, console))


async def _run(settings: Settings, console: Console) -> int:
    children: list[Child] = []
    stop = asyncio.create_task(stop_requested())
    work = asyncio.create_task(_start_and_watch(settings, children, console))
    try:
        await asyncio.wait({stop, work}, return_when=asyncio.FIRST_COMPLETED)
        if work.done():
            return _status(work)
        console.print(f"{stop.result()}: ending; the grip stays as it is")
        notify(STOPPING=1)
        return 0
    finally:
        work.cancel()
        await asyncio.gather(work, return_exceptions=True)
        # The service first, so that nobody gives a command to a dying control.
        for child in reversed(children):
            await child.end()


async def _start_and_watch(
    settings: Settings, children: list[Child], console: Console
) -> None:
    folder, common = settings.runtime_dir, ["--config", str(settings.source)]

    def child(name: str, silence: float | None = None) -> Child:
        children.append(Child(name, [name, *common], folder, silence))
        return children[-1]

    bench = child("bench") if simulated(settings) is not None else None
    control = child("control", CONTROL_SILENCE)
    service = child("service", SERVICE_SILENCE)
    async with asyncio.TaskGroup() as starts:
        # It loads most, and needs the others only to answer.
        starts.create_task(service.start())
        if bench is not None:
            await bench.start()
            address = bench.facts["ADDRESS"]
            # What is started again must be found where it was, also on a chosen port.
            bench.arguments += ["--tcp", address]
            control.arguments += ["--bench", address]
            console.print(f"bench    Modbus TCP on {address}, simulated: no hardware")
        await control.start()
        # The unit's own watchdog is fed by what matters.
        control.alive = feed
        console.print(f"control  {', '.join(settings.grippers)}")
    url = service.facts["ADDRESS"]
    service.arguments += ["--http", url.removeprefix("http://")]
    console.print(f"service  {url}   try {url}/v1/grippers, {url}/docs")
    notify(READY=1, STATUS=f"serving {url}")
    await supervise(children)


def _status(work: "asyncio.Task[None]") -> int:
    error = work.exception()
    if isinstance(error, BaseExceptionGroup):
        error = error.exceptions[0]
    if isinstance(error, StartFailed):
        return error.status or 1
    if error is not None:
        raise error
    return 0


@contextmanager
def _alone(folder: Path) -> Iterator[None]:
    """Hold the folder's lock, so that two daemons never share sockets or hardware."""
    with os.fdopen(_opened(folder / "lock"), "r+") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            message = f"gripperd runs already in {folder} (pid {lock.read().strip()})"
            hints = ("stop it, or give this one another runtime_dir",)
            raise Refused(message, code="already-running", hints=hints) from error
        lock.truncate(0)
        lock.write(str(os.getpid()))
        lock.flush()
        yield


def _opened(lock: Path) -> int:
    """Open a file of our own: what a link leads to would be emptied."""
    flags = os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_CLOEXEC
    try:
        opened = os.open(lock, flags, 0o600)
    except OSError as error:
        message = f"{lock} cannot be used as a lock: {error.strerror}"
        raise ConfigError(message) from error
    found = os.fstat(opened)
    if not stat.S_ISREG(found.st_mode) or found.st_nlink != 1:
        os.close(opened)
        message = f"{lock} cannot be used as a lock: it is a link, or no file"
        raise ConfigError(message)
    return opened
