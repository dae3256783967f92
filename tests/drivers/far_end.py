"""The far end of a bus of either kind, honest or not, as a test tells it."""

import asyncio
import fcntl
import os
import sys
import termios
import time
import tty
from abc import ABC, abstractmethod
from collections.abc import AsyncIterator, Callable, Mapping
from contextlib import asynccontextmanager
from dataclasses import dataclass
from pathlib import Path

from pymodbus.framer.rtu import FramerRTU

from gripperd.drivers.bus import ModbusBus, RtuAddress, TcpAddress, open_bus
from gripperd.protocol.modbus import Read, Table, Write

from .peer import SOON, Line, Peer, listening, up
from .steady import steady

PATIENCE = 0.1
"""Time-out of the serial lines, and so the silence that drains them. [s]"""


@dataclass(frozen=True)
class Asked:
    """One request as the far end has got it."""

    frame: bytes
    unit: int
    pdu: bytes
    at: float
    """On the monotonic clock. [s]"""

    @property
    def address(self) -> int:
        return int.from_bytes(self.pdu[1:3], "big")

    @property
    def value(self) -> int:
        return int.from_bytes(self.pdu[3:5], "big")


class FarEnd(ABC):
    """Hears requests and answers as `behave` says."""

    def __init__(self) -> None:
        self.behave: Callable[[FarEnd, Asked], None] = honest
        self.asked: list[Asked] = []

    @abstractmethod
    def framed(self, asked: Asked, pdu: bytes, unit: int) -> bytes:
        """A frame that answers a request."""

    @abstractmethod
    def put(self, octets: bytes) -> None:
        """Octets on the line."""

    def reply(self, asked: Asked, pdu: bytes, unit: int | None = None) -> None:
        self.put(self.framed(asked, pdu, asked.unit if unit is None else unit))

    def hear(self, frame: bytes, unit: int, pdu: bytes) -> None:
        asked = Asked(frame, unit, pdu, time.monotonic())
        self.asked.append(asked)
        self.behave(self, asked)

    async def has(self, count: int) -> None:
        """Return once so many requests have come."""
        async with asyncio.timeout(SOON):
            while len(self.asked) < count:  # noqa: ASYNC110
                await asyncio.sleep(0.001)


Behaviour = Callable[[FarEnd, Asked], None]


class TcpFarEnd(FarEnd):
    def __init__(self, peer: Peer) -> None:
        super().__init__()
        peer.behave = self._ask
        self._peer = peer

    def framed(self, asked: Asked, pdu: bytes, unit: int) -> bytes:
        length = (len(pdu) + 1).to_bytes(2, "big")
        return asked.frame[:4] + length + bytes([unit]) + pdu

    def put(self, octets: bytes) -> None:
        self._peer.lines[-1].send(octets)

    def hang_up(self) -> None:
        """Close the newest connection."""
        self._peer.lines[-1].hang_up()

    def _ask(self, line: Line, frame: bytes) -> None:
        self.hear(frame, frame[6], frame[7:])


class RtuFarEnd(FarEnd):
    """A pty; `path` is a link to it that outlives an unplugging."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.path = path
        self.heard = b""
        self._rest = b""
        self._end = b""
        self._answers: Mapping[bytes, bytes] = {}
        self._loop = asyncio.get_running_loop()
        self.plug()

    @property
    def plugged(self) -> bool:
        return self.path.is_symlink()

    @property
    def name(self) -> str:
        """Of the device that the path leads to."""
        return Path(os.ttyname(self._slave)).name

    @property
    def unread(self) -> int:
        """Octets that the kernel keeps for the other end."""
        room = fcntl.ioctl(self._slave, termios.FIONREAD, bytes(4))
        return int.from_bytes(room, sys.byteorder)

    def plug(self) -> None:
        self._master, self._slave = os.openpty()
        tty.setraw(self._slave)
        os.set_blocking(self._master, False)
        self.path.symlink_to(os.ttyname(self._slave))
        self._loop.add_reader(self._master, self._read)

    def unplug(self) -> None:
        self.path.unlink()
        self._loop.remove_reader(self._master)
        os.close(self._master)
        os.close(self._slave)

    def speak(self, end: bytes, answers: Mapping[bytes, bytes]) -> None:
        """Answer lines of text from now on."""
        self._end, self._answers = end, answers

    def deafen(self) -> None:
        """Take nothing off the line any more."""
        self._loop.remove_reader(self._master)

    def framed(self, asked: Asked, pdu: bytes, unit: int) -> bytes:
        return sealed(bytes([unit]) + pdu)

    def put(self, octets: bytes) -> None:
        os.write(self._master, octets)

    def _read(self) -> None:
        octets = os.read(self._master, 4096)
        self.heard += octets
        self._rest += octets
        while self._end and self._end in self._rest:
            line, _, self._rest = self._rest.partition(self._end)
            self.put(self._answers.get(line + self._end, b""))
        while not self._end and len(self._rest) >= 8:
            frame, self._rest = self._rest[:8], self._rest[8:]
            self.hear(frame, frame[0], frame[1:-2])


def sealed(octets: bytes) -> bytes:
    """With the checksum of pymodbus behind."""
    return octets + FramerRTU.compute_CRC(octets).to_bytes(2, "big")


def honest(far: FarEnd, asked: Asked) -> None:
    """Register 100 holds 1100, and so on; a write is echoed."""
    if asked.pdu[0] == 6:
        far.reply(asked, asked.pdu)
        return
    values = (1000 + asked.address + place for place in range(asked.value))
    octets = b"".join(value.to_bytes(2, "big") for value in values)
    far.reply(asked, bytes([asked.pdu[0], len(octets)]) + octets)


def dead(far: FarEnd, asked: Asked) -> None:
    """No answer."""


def once(misbehave: Behaviour) -> Behaviour:
    """Misbehave at the first request, be honest ever after."""

    def behave(far: FarEnd, asked: Asked) -> None:
        far.behave = honest
        misbehave(far, asked)

    return behave


@asynccontextmanager
async def over_tcp(patience: float) -> AsyncIterator[tuple[ModbusBus, TcpFarEnd]]:
    async with listening(lambda line, frame: None) as peer:
        address = TcpAddress(host="127.0.0.1", port=peer.port, timeout=patience)
        async with open_bus(address) as bus:
            steady(bus)
            await up(bus)
            yield bus, TcpFarEnd(peer)


@asynccontextmanager
async def plugged(path: Path) -> AsyncIterator[RtuFarEnd]:
    far = RtuFarEnd(path)
    try:
        yield far
    finally:
        if far.plugged:
            far.unplug()


@asynccontextmanager
async def over_rtu(
    path: Path,
    patience: float = PATIENCE,
    *,
    silence: float | None = None,
    local_echo: bool = False,
) -> AsyncIterator[tuple[ModbusBus, RtuFarEnd]]:
    async with plugged(path) as far:
        address = RtuAddress(
            port=str(path), timeout=patience, silence=silence, local_echo=local_echo
        )
        async with open_bus(address) as bus:
            steady(bus)
            await up(bus)
            yield bus, far


def read(address: int, count: int = 1, unit: int = 1) -> Read:
    return Read(unit, Table.HOLDING, address, count)


def write(value: int, address: int = 0) -> Write:
    return Write(1, address, (value,))
