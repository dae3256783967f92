"""A Modbus TCP bus: one owner, one request at a time, nothing believed unchecked.

After a timeout, a cancellation or a reply that does not fit, the connection is closed
and opened anew, so that a late reply can never answer the next request. A request is
sent once; who wants to try again says so.
"""

import asyncio
from collections import Counter, deque
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager, suppress
from dataclasses import dataclass, field
from typing import cast

from gripperd.errors import BadReply, DeviceRefused, LinkLost, ReplyTimeout
from gripperd.protocol import modbus

FIRST_BACK_OFF = 0.1
LAST_BACK_OFF = 0.5
"""Pause between attempts to connect, doubled from the first to the last; the last is
also the longest wait for one attempt. [s]"""


@dataclass(frozen=True, slots=True, kw_only=True)
class TcpAddress:
    """Where a Modbus TCP device or gateway listens."""

    host: str
    port: int
    timeout: float = 0.2
    """Longest wait for a reply. [s]"""

    def __str__(self) -> str:
        """As in a configuration file."""
        return f"{self.host}:{self.port}"


@dataclass(slots=True)
class BusStatistics:
    """What has happened on the bus since it was opened."""

    requests: int = 0
    connections: int = 0
    errors: Counter[str] = field(default_factory=Counter)
    """By the name of the error."""


class _Wire(asyncio.Protocol):
    """One open connection: cuts the stream into frames for whoever waits."""

    def __init__(self) -> None:
        self.transport: asyncio.Transport | None = None
        self.closed = asyncio.Event()
        self._buffer = bytearray()
        self._reply: asyncio.Future[bytes] | None = None

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        # uvloop has transports of its own that are no subclass.
        self.transport = cast("asyncio.Transport", transport)

    def data_received(self, octets: bytes) -> None:
        self._buffer += octets
        try:
            length = modbus.frame_length(self._buffer)
        except BadReply as error:
            self._answer(error)
            return
        if length is None or len(self._buffer) < length:
            return
        frame = bytes(self._buffer[:length])
        del self._buffer[:length]
        self._answer(frame)

    def connection_lost(self, exc: Exception | None) -> None:
        self.closed.set()
        self._answer(LinkLost("the peer closed the connection"))

    def _answer(self, outcome: bytes | Exception) -> None:
        if self._reply is None or self._reply.done():
            return
        if isinstance(outcome, Exception):
            self._reply.set_exception(outcome)
        else:
            self._reply.set_result(outcome)

    def send(self, frame: bytes) -> "asyncio.Future[bytes]":
        """Write a request; the future is its reply."""
        assert self.transport is not None
        if self.transport.is_closing():
            message = "the peer has closed the connection"
            raise LinkLost(message)
        if self._buffer:
            message = f"octets nobody asked for: {bytes(self._buffer[:32]).hex(' ')}"
            raise BadReply(message)
        self._reply = asyncio.get_running_loop().create_future()
        self.transport.write(frame)
        return self._reply

    def close(self) -> None:
        assert self.transport is not None
        self.transport.abort()


class Turns:
    """Mutual exclusion in which an urgent request passes all that wait."""

    def __init__(self) -> None:
        self._taken = False
        self._urgent: deque[asyncio.Future[None]] = deque()
        self._waiting: deque[asyncio.Future[None]] = deque()

    async def take(self, *, urgent: bool) -> None:
        """Return when it is the caller's turn."""
        if not self._taken:
            self._taken = True
            return
        queue = self._urgent if urgent else self._waiting
        turn: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        queue.append(turn)
        try:
            await turn
        except asyncio.CancelledError:
            if turn.done() and not turn.cancelled():
                self.give()
            elif turn in queue:
                queue.remove(turn)
            raise

    def give(self) -> None:
        """Hand the turn to the next in line."""
        for queue in (self._urgent, self._waiting):
            while queue:
                turn = queue.popleft()
                if not turn.done():
                    turn.set_result(None)
                    return
        self._taken = False


class Bus:
    """The one owner of a connection. Make it with :func:`open_bus`."""

    def __init__(self, address: TcpAddress) -> None:
        self.address = address
        self.statistics = BusStatistics()
        self.up = asyncio.Event()
        self._turns = Turns()
        self._wire: _Wire | None = None
        self._transaction = 0

    async def ask(
        self,
        request: modbus.Request | Callable[[], modbus.Request],
        *,
        urgent: bool = False,
    ) -> tuple[int, ...]:
        """Send one request, once, and return its checked reply.

        Parameters
        ----------
        request
            What to read or write; a function is asked when its turn has come.
        urgent
            Go before everything that waits, after the request in flight.

        Returns
        -------
        The registers read, or written.

        Raises
        ------
        LinkLost
            There is no connection; it is being opened anew meanwhile.
        ReplyTimeout
            No reply in time; the request may or may not have been carried out.
        BadReply
            A reply that does not fit the request.
        DeviceRefused
            The device answered with an exception; the line is sound.
        """
        await self._turns.take(urgent=urgent)
        try:
            return await self._exchange(request() if callable(request) else request)
        finally:
            self._turns.give()

    async def _exchange(self, request: modbus.Request) -> tuple[int, ...]:
        wire = self._wire
        if wire is None:
            message = f"no connection to {self.address}"
            raise LinkLost(message)
        self.statistics.requests += 1
        self._transaction = self._transaction % 0xFFFF + 1
        try:
            reply = wire.send(modbus.encode_request(request, self._transaction))
            async with asyncio.timeout(self.address.timeout):
                frame = await reply
            return modbus.decode_reply(request, self._transaction, frame)
        except DeviceRefused:
            self.statistics.errors["DeviceRefused"] += 1
            raise
        except TimeoutError as error:
            self._drop("ReplyTimeout")
            message = (
                f"{self.address} did not answer within"
                f" {self.address.timeout * 1e3:g} ms: {request}"
            )
            raise ReplyTimeout(message) from error
        except BaseException as error:
            # Cancelled in flight, a misfit reply or a lost peer: what comes next on
            # this connection could answer the wrong question.
            self._drop(type(error).__name__)
            raise

    def _drop(self, why: str) -> None:
        self.statistics.errors[why] += 1
        self.up.clear()
        if self._wire is not None:
            self._wire.close()
            self._wire = None

    async def supervise(self) -> None:
        """Connect, and connect again after every loss, for ever."""
        pause = FIRST_BACK_OFF
        while True:
            try:
                await self._connect()
            except (OSError, TimeoutError, UnicodeError):
                self.statistics.errors["connect"] += 1
                await asyncio.sleep(pause)
                pause = min(2 * pause, LAST_BACK_OFF)
                continue
            pause = FIRST_BACK_OFF
            wire = self._wire
            if wire is not None:
                await wire.closed.wait()
            self.up.clear()
            self._wire = None
            # A peer that accepts and hangs up at once must not be stormed.
            await asyncio.sleep(FIRST_BACK_OFF)

    async def _connect(self) -> None:
        loop = asyncio.get_running_loop()
        async with asyncio.timeout(LAST_BACK_OFF):
            _, wire = await loop.create_connection(
                _Wire, self.address.host, self.address.port
            )
        self._wire = wire
        self.statistics.connections += 1
        self.up.set()

    def close(self) -> None:
        """Close the connection, if there is one."""
        if self._wire is not None:
            self._wire.close()


@asynccontextmanager
async def open_bus(address: TcpAddress) -> AsyncIterator[Bus]:
    """Own a bus while inside; it connects by itself, now or when the peer is there."""
    bus = Bus(address)
    supervisor = asyncio.create_task(bus.supervise(), name=f"bus {address}")
    try:
        yield bus
    finally:
        supervisor.cancel()
        with suppress(asyncio.CancelledError):
            await supervisor
        bus.close()
