"""The rig in real time, and its modules on Modbus TCP."""

import asyncio
import time
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager, suppress
from random import Random
from typing import NamedTuple, cast

from gripperd.bench.modbus_speaker import TcpSpeaker
from gripperd.bench.modules import Modules
from gripperd.bench.speaker import Speaker
from gripperd.bench.wire_faults import Asked, WireFault, WireFaultKind, WireFaults
from gripperd.errors import BadReply, Refused

TICK = 0.02
"""The rig catches up this often when nobody asks. [s]"""


class Reply(NamedTuple):
    """What goes back on the wire."""

    octets: bytes
    """Nothing where nobody answers."""
    delay: float = 0.0
    """[s]"""


class BenchServer:
    """Lets the rig live in real time and answers its clients, honestly or not.

    Parameters
    ----------
    modules
        What is on the line.
    now
        A clock that never steps. [s]
    speaker
        How the line is spoken on; Modbus TCP unless told.
    faults
        What goes wrong on it; nothing unless told.
    """

    def __init__(
        self,
        modules: Modules,
        now: Callable[[], float],
        speaker: Speaker | None = None,
        faults: WireFaults | None = None,
    ) -> None:
        self.clients: set[asyncio.Transport] = set()
        self.address = ""
        """Where it listens, once it does."""
        self.speaker = speaker or TcpSpeaker(modules)
        self.faults = faults or WireFaults(Random(0))
        self.modules = modules
        self._now = now
        self._start = now()

    def catch_up(self) -> None:
        """Bring the rig to the present."""
        self.modules.advance(self._now() - self._start)

    def answer(self, frame: bytes) -> bytes:
        """Reply to one request, honestly."""
        self.catch_up()
        return self.speaker.answer(frame)

    def respond(self, frame: bytes) -> Reply:
        """Reply to one request, or what a fault makes of it."""
        self.catch_up()
        if self.faults.idle:
            return Reply(self.speaker.answer(frame))
        asked = self.speaker.asked(frame)
        fault = self.faults.meet(asked)
        if fault is None:
            return Reply(self.speaker.answer(frame))
        self._befall(fault, asked)
        delay = fault.delay if fault.kind is WireFaultKind.LATE else 0.0
        return Reply(self.speaker.spoilt(fault, frame), delay)

    async def live(self) -> None:
        """Catch up now and then, so that nobody who asks has to wait for it."""
        while True:
            self.catch_up()
            await asyncio.sleep(TICK)

    def _befall(self, fault: WireFault, asked: Asked) -> None:
        """Change the modules that are asked, before they answer."""
        units = asked.units if fault.unit is None else {fault.unit}
        for unit in units:
            match fault.kind:
                case WireFaultKind.WATCHDOG_TRIPPED:
                    self.modules.trip(unit)
                case WireFaultKind.OPEN_LOOP:
                    self.modules.cut_loop(unit)
                case WireFaultKind.POWER_CYCLED:
                    self.modules.power_cycle(unit)
                case _:
                    pass


class _Connection(asyncio.Protocol):
    """One client."""

    def __init__(self, bench: BenchServer) -> None:
        self._bench = bench
        self._buffer = bytearray()
        self._transport: asyncio.Transport | None = None

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        # uvloop has transports of its own that are no subclass.
        self._transport = cast("asyncio.Transport", transport)
        self._bench.clients.add(self._transport)

    def connection_lost(self, exc: Exception | None) -> None:
        if self._transport is not None:
            self._bench.clients.discard(self._transport)

    def data_received(self, octets: bytes) -> None:
        assert self._transport is not None
        self._buffer += octets
        try:
            while length := self._bench.speaker.request_length(self._buffer):
                frame = bytes(self._buffer[:length])
                del self._buffer[:length]
                self._send(self._bench.respond(frame))
        except BadReply:
            self._transport.abort()

    def _send(self, reply: Reply) -> None:
        if reply.delay:
            loop = asyncio.get_running_loop()
            loop.call_later(reply.delay, self._send, reply._replace(delay=0.0))
        elif self._transport is not None and not self._transport.is_closing():
            self._transport.write(reply.octets)


@asynccontextmanager
async def serve_bench(
    modules: Modules,
    host: str,
    port: int,
    now: Callable[[], float] = time.monotonic,
    faults: WireFaults | None = None,
) -> AsyncIterator[BenchServer]:
    """Serve the rig on Modbus TCP while inside; port 0 takes a free one.

    Raises
    ------
    InputError
        A module does not speak Modbus.
    Refused
        When it cannot listen there.
    """
    bench = BenchServer(modules, now, faults=faults)
    loop = asyncio.get_running_loop()
    try:
        server = await loop.create_server(lambda: _Connection(bench), host, port)
    except OSError as error:
        message = f"the bench cannot listen on {host}:{port}: {error.strerror}"
        raise Refused(message, code="port-taken") from error
    found, chosen = server.sockets[0].getsockname()[:2]
    bench.address = f"{found}:{chosen}"
    try:
        async with living(bench):
            yield bench
    finally:
        server.close()
        for client in tuple(bench.clients):
            client.abort()


@asynccontextmanager
async def living(bench: BenchServer) -> AsyncIterator[None]:
    """Let the rig live while inside."""
    life = asyncio.create_task(bench.live())
    try:
        yield
    finally:
        life.cancel()
        with suppress(asyncio.CancelledError):
            await life
