"""One client's connection, which gives way when there are too many.

A web server that lets everybody connect and wait can be kept from answering with a few
slow clients: each takes a file, and says its request a letter at a time.
"""

import asyncio
from collections import OrderedDict
from typing import Any

from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol

LONGEST_WAIT = 10.0
"""Time for the headers of a request, from the connection or the last answer. [s]"""
MOST_CONNECTIONS = 512
"""Half of the files that a process may open where nobody has raised the limit."""


class Waiting:
    """The connections without a request, the one that waits longest first."""

    def __init__(self) -> None:
        self._connections: OrderedDict[Connection, None] = OrderedDict()

    def enter(self, connection: "Connection") -> None:
        """Wait behind all others."""
        self._connections[connection] = None
        self._connections.move_to_end(connection)

    def leave(self, connection: "Connection") -> None:
        """Wait no more, if it did."""
        self._connections.pop(connection, None)

    def give_way(self) -> None:
        """Close the connection that waits longest, if there is one."""
        if self._connections:
            self._connections.popitem(last=False)[0].close()


class Connection(HttpToolsProtocol):
    """Closes when no request comes, or when newer ones need the place.

    Parameters
    ----------
    waiting
        All of the server's connections that wait.
    most
        How many connections there may be.
    longest_wait
        Time for the headers of a request. [s]
    server
        What uvicorn gives to its connections.
    """

    def __init__(
        self,
        waiting: Waiting,
        most: int,
        longest_wait: float,
        **server: Any,  # noqa: ANN401 - uvicorn's affair
    ) -> None:
        super().__init__(**server)
        self._waiting = waiting
        self._most = most
        self._longest_wait = longest_wait
        self._patience: asyncio.TimerHandle | None = None

    def connection_made(  # type: ignore[override] # as in uvicorn
        self, transport: asyncio.Transport
    ) -> None:
        """Wait for the first request, in the place of another if need be."""
        super().connection_made(transport)
        if len(self.connections) > self._most:
            self._waiting.give_way()
        self._wait()

    def on_headers_complete(self) -> None:
        """Answer a request."""
        self._stop_waiting()
        super().on_headers_complete()

    def on_response_complete(self) -> None:
        """Wait for the next request, unless it came already."""
        super().on_response_complete()
        if self.cycle.response_complete and not self.transport.is_closing():
            self._wait()

    def connection_lost(self, exc: Exception | None) -> None:
        """Leave nothing behind."""
        self._stop_waiting()
        super().connection_lost(exc)

    def close(self) -> None:
        """Hang up, without a word: nothing was asked."""
        self.connections.discard(self)
        self.transport.abort()

    def _wait(self) -> None:
        self._stop_waiting()
        self._waiting.enter(self)
        self._patience = self.loop.call_later(self._longest_wait, self.close)

    def _stop_waiting(self) -> None:
        self._waiting.leave(self)
        if self._patience is not None:
            self._patience.cancel()
            self._patience = None
