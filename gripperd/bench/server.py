"""The rig on the wire: a Modbus TCP server in front of its modules."""

import asyncio
import time
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager, suppress
from typing import cast

from gripperd.bench.modules import Modules
from gripperd.errors import BadReply, Refused
from gripperd.protocol import modbus

TICK = 0.02
"""The rig catches up this often when nobody asks. [s]"""


class _Connection(asyncio.Protocol):
    """One client."""

    def __init__(self, bench: "BenchServer") -> None:
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
            while length := modbus.frame_length(self._buffer):
                if len(self._buffer) < length:
                    return
                frame = bytes(self._buffer[:length])
                del self._buffer[:length]
                self._transport.write(self._bench.answer(frame))
        except BadReply:
            self._transport.abort()


class BenchServer:
    """Lets the rig live in real time and answers its clients."""

    def __init__(self, modules: Modules, now: Callable[[], float]) -> None:
        self.clients: set[asyncio.Transport] = set()
        self.address = ""
        """Where it listens, once it does."""
        self._modules = modules
        self._now = now
        self._start = now()

    def catch_up(self) -> None:
        """Bring the rig to the present."""
        self._modules.rig.advance(self._now() - self._start)

    def answer(self, frame: bytes) -> bytes:
        """Reply to one request."""
        self.catch_up()
        request = modbus.decode_request(frame)
        if isinstance(request, modbus.Refusal):
            return modbus.encode_refusal(frame, request)
        answer = self._modules.answer(request)
        if isinstance(answer, modbus.Refusal):
            return modbus.encode_refusal(frame, answer)
        return modbus.encode_reply(request, modbus.transaction_of(frame), tuple(answer))

    async def live(self) -> None:
        """Catch up now and then, so that nobody who asks has to wait for it."""
        while True:
            self.catch_up()
            await asyncio.sleep(TICK)


@asynccontextmanager
async def serve_bench(
    modules: Modules,
    host: str,
    port: int,
    now: Callable[[], float] = time.monotonic,
) -> AsyncIterator[BenchServer]:
    """Serve the rig on Modbus TCP while inside; port 0 takes a free one.

    Raises
    ------
    Refused
        When it cannot listen there.
    """
    bench = BenchServer(modules, now)
    loop = asyncio.get_running_loop()
    try:
        server = await loop.create_server(lambda: _Connection(bench), host, port)
    except OSError as error:
        message = f"the bench cannot listen on {host}:{port}: {error.strerror}"
        raise Refused(message, code="port-taken") from error
    found, chosen = server.sockets[0].getsockname()[:2]
    bench.address = f"{found}:{chosen}"
    living = asyncio.create_task(bench.live())
    try:
        yield bench
    finally:
        living.cancel()
        with suppress(asyncio.CancelledError):
            await living
        server.close()
        for client in tuple(bench.clients):
            client.abort()
