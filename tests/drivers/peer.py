"""A Modbus TCP peer that behaves, or misbehaves, as a test tells it to."""

import asyncio
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from typing import TypeVar, cast

from gripperd.drivers.bus import Bus, ModbusBus, TcpAddress, open_bus
from gripperd.protocol.modbus import Write

from .steady import steady

Q = TypeVar("Q")
R = TypeVar("R")

SOON = 60.0
"""Longest wait for something that must happen; no test takes this long. [s]"""
REQUEST = 12
"""Octets of every request that the tests send."""


class Line(asyncio.Protocol):
    """One connection, seen from the peer."""

    def __init__(self, peer: "Peer") -> None:
        self.closed = asyncio.Event()
        self._peer = peer
        self._buffer = bytearray()
        self._transport: asyncio.Transport | None = None

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        self._transport = cast("asyncio.Transport", transport)
        self._peer.lines.append(self)
        self._peer.news.set()

    def connection_lost(self, exc: Exception | None) -> None:
        self.closed.set()

    def data_received(self, octets: bytes) -> None:
        self._buffer += octets
        while len(self._buffer) >= REQUEST:
            frame = bytes(self._buffer[:REQUEST])
            del self._buffer[:REQUEST]
            self._peer.requests.append(frame)
            self._peer.news.set()
            self._peer.behave(self, frame)

    def send(self, octets: bytes) -> None:
        """Put octets on the line; once it is closed they go nowhere."""
        assert self._transport is not None
        if not self.closed.is_set():
            self._transport.write(octets)

    def hang_up(self) -> None:
        """Close the line from this end, once what was sent is out."""
        assert self._transport is not None
        self._transport.close()


Behaviour = Callable[[Line, bytes], None]


class Peer:
    """A server; `behave` says what it does with each request."""

    def __init__(self, behave: Behaviour) -> None:
        self.behave = behave
        self.lines: list[Line] = []
        self.requests: list[bytes] = []
        self.news = asyncio.Event()
        self.port = 0

    async def asked(self, count: int) -> None:
        """Return once so many requests have arrived, on whatever line."""
        await self._until(lambda: len(self.requests) >= count)

    async def called(self, count: int) -> None:
        """Return once so many connections were made."""
        await self._until(lambda: len(self.lines) >= count)

    async def _until(self, happened: Callable[[], bool]) -> None:
        async with asyncio.timeout(SOON):
            while not happened():
                self.news.clear()
                await self.news.wait()


@asynccontextmanager
async def listening(behave: Behaviour, port: int = 0) -> AsyncIterator[Peer]:
    """Listen on loopback while inside; afterwards every line is closed."""
    peer = Peer(behave)
    loop = asyncio.get_running_loop()
    server = await loop.create_server(lambda: Line(peer), "127.0.0.1", port)
    peer.port = server.sockets[0].getsockname()[1]
    try:
        yield peer
    finally:
        server.close()
        for line in peer.lines:
            line.hang_up()
        async with asyncio.timeout(SOON):
            for line in peer.lines:
                await line.closed.wait()


def echo(line: Line, frame: bytes) -> None:
    """Answer a write as the specification says: with the request itself."""
    line.send(frame)


def silence(line: Line, frame: bytes) -> None:
    """Answer nothing."""


@asynccontextmanager
async def connected(
    behave: Behaviour, patience: float = SOON
) -> AsyncIterator[tuple[ModbusBus, Peer]]:
    """A bus on a peer that behaves so; `patience` is its time-out."""
    async with listening(behave) as peer:
        address = TcpAddress(host="127.0.0.1", port=peer.port, timeout=patience)
        async with open_bus(address) as bus:
            steady(bus)
            await up(bus)
            yield bus, peer


async def up(bus: Bus[Q, R]) -> None:
    """Return once there is a connection."""
    async with asyncio.timeout(SOON):
        await bus.up.wait()


async def closed(line: Line) -> None:
    """Return once a line is closed."""
    async with asyncio.timeout(SOON):
        await line.closed.wait()


def write(value: int) -> Write:
    """The request that the tests send."""
    return Write(1, 0, (value,))


def value_of(frame: bytes) -> int:
    """The value in such a request."""
    return int.from_bytes(frame[10:12], "big")


def once(misbehave: Behaviour) -> Behaviour:
    """Misbehave at the first request, be honest ever after."""
    honest = False

    def behave(line: Line, frame: bytes) -> None:
        nonlocal honest
        (echo if honest else misbehave)(line, frame)
        honest = True

    return behave
