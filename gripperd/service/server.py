"""The web server: one process, one socket, no surprises."""

import asyncio
import errno
import socket
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from typing import Any, cast

import uvicorn
from starlette.types import ASGIApp

from gripperd.errors import Refused
from gripperd.service.connection import (
    LONGEST_WAIT,
    MOST_CONNECTIONS,
    Connection,
    Waiting,
)
from gripperd.service.crowd import MOST_REQUESTS, Crowd
from gripperd.units import MILLI

LONGEST_STUCK = 10.0
"""Time for which a client may leave what was sent to it where it is. [s]"""
GRACE = 2
"""How long requests in flight may take when the server ends. [s]"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Limits:
    """What the server puts up with."""

    connections: int = MOST_CONNECTIONS
    requests: int = MOST_REQUESTS
    """That are being answered at a time."""
    wait: float = LONGEST_WAIT
    """For the headers of a request. [s]"""
    stuck: float = LONGEST_STUCK
    """For a client that reads nothing of its answer. [s]"""


class _Server(uvicorn.Server):
    """Tells when it listens, and leaves signals to the owner of the process."""

    def __init__(self, config: uvicorn.Config, on_ready: Callable[[], None]) -> None:
        super().__init__(config)
        self._on_ready = on_ready

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        await super().startup(sockets)
        self._on_ready()

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """Let requests in flight end, and hang up on those that do not."""
        loop = asyncio.get_running_loop()
        patience = loop.call_later(GRACE, self._hang_up)
        try:
            await super().shutdown(sockets)
        finally:
            patience.cancel()

    def _hang_up(self) -> None:
        for connection in tuple(self.server_state.connections):
            connection.transport.abort()
        for request in tuple(self.server_state.tasks):
            request.cancel()

    @contextmanager
    def capture_signals(self) -> Iterator[None]:
        yield


async def serve(
    app: ASGIApp,
    host: str,
    port: int,
    on_ready: Callable[[str], None],
    limits: Limits = Limits(),
) -> None:
    """Serve until cancelled; requests in flight may end.

    Parameters
    ----------
    app
        What answers.
    host, port
        Where to listen; port 0 takes a free one.
    on_ready
        Called with the URL once connections are accepted.
    limits
        What it puts up with.

    Raises
    ------
    Refused
        When it cannot listen there.
    """
    listening = await _bound(host, port, limits.stuck)
    url = _url(listening)
    connection = partial(Connection, Waiting(), limits.connections, limits.wait)
    config = uvicorn.Config(
        Crowd(app, limits.requests),
        # Whatever makes a connection will do; uvicorn only asks for less.
        http=cast("type[asyncio.Protocol]", connection),
        ws="none",
        lifespan="off",
        log_config=None,
        access_log=False,
        proxy_headers=False,
        server_header=False,
    )
    server = _Server(config, lambda: on_ready(url))
    serving = asyncio.create_task(server.serve([listening]))
    try:
        await asyncio.shield(serving)
    except asyncio.CancelledError:
        server.should_exit = True
        await serving
        raise


async def _bound(host: str, port: int, stuck: float) -> socket.socket:
    try:
        loop = asyncio.get_running_loop()
        found = await loop.getaddrinfo(host, port, type=socket.SOCK_STREAM)
        return _listening(*found[0][:3], address=found[0][4], stuck=stuck)
    except OSError as error:
        where = f"http.host = {host}, http.port = {port}"
        reason = f"cannot listen there: {error.strerror}"
        if error.errno == errno.EADDRINUSE:
            reason = "another program listens there"
        # Not the configuration's fault: the other program may go away, the address
        # may come up.
        raise Refused(f"{where}: {reason}", code="cannot-listen") from error


def _listening(
    family: int,
    kind: int,
    protocol: int,
    *,
    address: tuple[Any, ...],
    stuck: float,
) -> socket.socket:
    # With its protocol named, the event loop knows to switch off Nagle's delay.
    made = socket.socket(family, kind, protocol)
    try:
        made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        # Every connection inherits it (tcp(7)). The kernel would keep megabytes for
        # each client that reads nothing, and never tell.
        patience = round(stuck / MILLI)
        made.setsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT, patience)
        made.bind(address)
        made.listen()
    except OSError:
        made.close()
        raise
    return made


def _url(listening: socket.socket) -> str:
    host, port = listening.getsockname()[:2]
    return f"http://[{host}]:{port}" if ":" in host else f"http://{host}:{port}"
