"""Serial ports of this machine, looked at without opening them."""

import errno
import os
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from serial.tools import list_ports

from gripperd.doctor.finding import Finding, Result
from gripperd.drivers.serial_port import complaint, latency_timer

QUICK = 1
"""Latency timer that costs nothing worth mentioning. [ms]"""


@dataclass(frozen=True, slots=True, kw_only=True)
class SerialPort:
    """One port, as it stands."""

    path: str
    """The lasting name under ``/dev/serial/by-id`` where there is one."""
    title: str
    """What the adapter says it is, "" if nothing."""
    trouble: str
    """Why this user cannot open it, "" if it can."""
    latency_timer: int | None
    """How long the adapter gathers octets; None where it does not tell. [ms]"""
    users: tuple[int, ...]
    """Processes that have it open, as far as this user may see them."""

    @property
    def findings(self) -> Iterator[Finding]:
        """Everything that can be said without opening it."""
        name = self.title or "a serial port"
        opened = Result.ok(f"{name}, may be opened")
        if self.trouble:
            opened = Result.failed(self.trouble, "log in again once that is done")
        yield Finding(self.path, "permission", opened)
        if self.users:
            said = f"process {' and '.join(map(str, self.users))} has it open"
            remedy = "end that process before anything else uses the port"
            yield Finding(self.path, "exclusive use", Result.warning(said, remedy))
        if self.latency_timer is not None:
            yield Finding(self.path, "latency timer", _latency(self.latency_timer))


def serial_ports(root: Path = Path("/")) -> list[SerialPort]:
    """Every serial port that the system tells of.

    Parameters
    ----------
    root
        Where ``dev``, ``proc`` and ``sys`` are.
    """
    return [
        serial_port(Path(found.device), root, found.product or "")
        for found in list_ports.comports()
    ]


def serial_port(device: Path, root: Path = Path("/"), title: str = "") -> SerialPort:
    """One serial port.

    Parameters
    ----------
    device, title
        Its path, and what the adapter says it is.
    root
        Where ``dev``, ``proc`` and ``sys`` are.
    """
    trouble = ""
    if not device.exists():
        trouble = complaint(str(device), FileNotFoundError(errno.ENOENT, ""))
    elif not os.access(device, os.R_OK | os.W_OK):
        trouble = complaint(str(device), PermissionError(errno.EACCES, ""))
    return SerialPort(
        path=_lasting(device, root),
        title=title,
        trouble=trouble,
        latency_timer=latency_timer(str(device), root / "sys"),
        users=tuple(sorted(_users(device, root / "proc"))),
    )


def _lasting(device: Path, root: Path) -> str:
    """Name that survives a restart, or the given one."""
    for link in sorted((root / "dev/serial/by-id").glob("*")):
        if link.resolve() == device.resolve():
            return str(link)
    return str(device)


def _users(device: Path, proc: Path) -> set[int]:
    """Processes with an open descriptor on it; those of other users stay hidden."""
    target, found = device.resolve(), set()
    for process in proc.glob("[0-9]*"):
        # Processes end, and descriptors are closed, while one looks.
        with suppress(OSError):
            if any(_leads_to(each, target) for each in process.glob("fd/*")):
                found.add(int(process.name))
    return found


def _leads_to(descriptor: Path, target: Path) -> bool:
    try:
        return descriptor.readlink() == target
    except OSError:
        return False


def _latency(timer: int) -> Result:
    if timer <= QUICK:
        return Result.ok(f"{timer} ms")
    said = f"{timer} ms: every reply comes up to that much later"
    return Result.warning(said, "set it to 1 ms, as docs/serial.md shows")
