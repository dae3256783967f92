"""The program, run for real on free ports, for tests and benchmarks."""

import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any, NamedTuple

import httpx

from gripperd.config import shipped

START = (sys.executable, "-m", "gripperd")
PATIENCE = 240.0
"""Longest wait for an answer, or for what is bound to happen. [s]"""


class Daemon(NamedTuple):
    """Where a running daemon is found."""

    url: str
    bench: tuple[str, int]
    process: "subprocess.Popen[str]"


def settings_file(folder: Path) -> Path:
    """The shipped settings with free ports and sockets of their own.

    Where the folder has profiles of its own, they take the place of the shipped ones.
    """
    text = shipped("gripperd.yaml").read_text()
    text = text.replace("port: 8765", "port: 0").replace(":15020", ":0")
    for name in ("models", "profiles"):
        text = text.replace(f": {name}", f": {shipped(name)}")
    own = folder / "profiles"
    if own.is_dir():
        text = text.replace(str(shipped("profiles")), own.name)
    path = folder / "gripperd.yaml"
    places = f"runtime_dir: {folder / 'run'}\nstate_dir: {folder / 'state'}\n"
    path.write_text(places + text)
    return path


def gripperd(*arguments: str, **environment: str) -> "subprocess.CompletedProcess[str]":
    """Run a command to its end."""
    return subprocess.run(
        [*START, *arguments],
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        check=False,
        env=os.environ | environment,
    )


@contextmanager
def running(
    *arguments: str, within: Sequence[str] = (), **environment: str
) -> "Iterator[subprocess.Popen[str]]":
    """Run a command inside, and end it as a service manager would.

    `within` is the beginning of a command line that ends with what to execute.
    """
    process = subprocess.Popen(
        [*within, *START, *arguments],
        stdout=subprocess.PIPE,
        text=True,
        env=os.environ | {"PYTHONUNBUFFERED": "1"} | environment,
    )
    try:
        yield process
    finally:
        process.send_signal(signal.SIGTERM)
        process.wait(PATIENCE)
        assert process.stdout is not None
        process.stdout.close()


@contextmanager
def running_daemon(
    folder: Path, within: Sequence[str] = (), **environment: str
) -> Iterator[Daemon]:
    """Run the daemon inside, ready."""
    arguments = ("run", "--config", str(settings_file(folder)))
    with running(*arguments, within=within, **environment) as process:
        assert process.stdout is not None
        host, port = found(process.stdout, r"TCP on ([\d.]+):(\d+)")
        (url,) = found(process.stdout, r"(http://\S+)")
        # It is ready without its hardware, too, when that is slow.
        until(lambda: attached(f"{url}/v1/grippers/g0"))
        yield Daemon(url, (host, int(port)), process)


def found(lines: IO[str], pattern: str) -> tuple[str, ...]:
    """Groups of the first line that matches."""
    for line in lines:
        match = re.search(pattern, line)
        if match:
            return match.groups()
    message = f"the program ended before it said {pattern}"
    raise RuntimeError(message)


def document(url: str) -> dict[str, Any]:
    """What the daemon answers there."""
    found: dict[str, Any] = httpx.get(url, timeout=PATIENCE).json()
    return found


def attached(gripper: str) -> bool:
    """Whether control has found the hardware as it is."""
    return document(gripper).get("machine") not in {None, "offline", "attaching"}


def until(condition: Callable[[], object], patience: float = PATIENCE) -> None:
    """Wait for something that is bound to happen."""
    end = time.monotonic() + patience
    while not condition():
        assert time.monotonic() < end, "it did not happen"
        time.sleep(0.02)


def children(process: "subprocess.Popen[str]") -> dict[str, int]:
    """Process ids of the daemon's parts, by name."""
    listing = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text()
    names = {}
    for pid in listing.split():
        command = _command_line(int(pid))
        if "gripperd" in command:
            names[command[command.index("gripperd") + 1]] = int(pid)
    return names


def _command_line(process: int) -> list[str]:
    """Words; none of a process that has just died."""
    try:
        return Path(f"/proc/{process}/cmdline").read_text().split("\0")
    except OSError:
        return []
