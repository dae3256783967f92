"""What every open line has in common: a stream that is cut into replies."""

import asyncio
from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Generic, Protocol, TypeAlias, TypeVar

from gripperd.drivers.statistics import BusStatistics
from gripperd.errors import BadReply, LinkError, LinkLost, ReplyTimeout

Q = TypeVar("Q")
"""A request."""

Cut: TypeAlias = Callable[[Q, bytearray], int | None]
"""Length of the reply at the start of a buffer, see `Dialect.frame_length`."""


class Line(ABC, Generic[Q]):
    """One open connection, until it is lost or closed.

    Parameters
    ----------
    name
        Of the peer, for messages.
    cut
        Finds the end of a reply.
    statistics
        Counts what is thrown away.
    """

    def __init__(self, name: str, cut: Cut[Q], statistics: BusStatistics) -> None:
        self.closed = asyncio.Event()
        self.received = bytearray()
        """Octets that no reply has claimed."""
        self.proved = True
        """Whether what comes back is known to be more than an echo."""
        self.spoiled = False
        """Whether octets may still come that answer an earlier request."""
        self.halting = False
        """Whether to `pause` before every request."""
        self.outage = ""
        """Why it is closed."""
        self._name = name
        self._cut = cut
        self._statistics = statistics
        self._loop = asyncio.get_running_loop()
        self._request: Q
        self._reply: asyncio.Future[bytes] | None = None
        self._overdue: asyncio.TimerHandle | None = None

    @abstractmethod
    def send(self, request: Q, octets: bytes, timeout: float) -> asyncio.Future[bytes]:
        """Put a request on the line; the future is its reply, not yet judged.

        Raises
        ------
        LinkLost
            It could not be sent.
        BadReply
            Octets that nobody asked for have come, and nobody knows what they are.
        """

    @abstractmethod
    def spoil(self) -> None:
        """Note that what comes next could answer a request that is over."""

    @abstractmethod
    def close(self, why: str = "the bus was closed") -> None:
        """Close it now; who waits for a reply is told why."""

    @abstractmethod
    def overhear(self) -> None:
        """Deal with octets that came while nobody waited for a reply."""

    async def pause(self) -> None:
        """Return when a request may start."""

    async def drain(self) -> None:
        """Return when a spoiled line is sound again, or closed."""

    def expect(self, request: Q, timeout: float) -> asyncio.Future[bytes]:
        """Wait for the reply to a request that is being sent. [s]."""
        self._request = request
        self._reply = self._loop.create_future()
        self._overdue = self._loop.call_later(timeout, self._time_out, timeout)
        return self._reply

    def hear(self, octets: bytes) -> None:
        """Take what has come, and answer once the reply is complete."""
        self.received += octets
        if self._reply is None:
            self.overhear()
            return
        try:
            length = self._cut(self._request, self.received)
        except LinkError as error:
            self.answer(error)
            return
        if length is None:
            return
        frame = bytes(self.received[:length])
        del self.received[:length]
        self.answer(frame)

    def answer(self, outcome: bytes | LinkError) -> None:
        """Tell who waits, if anybody does."""
        reply = self._reply
        self.forget()
        if reply is None or reply.done():
            return
        if isinstance(outcome, LinkError):
            reply.set_exception(outcome)
        else:
            reply.set_result(outcome)

    def forget(self) -> None:
        """Wait for nothing any more."""
        self._reply = None
        if self._overdue is not None:
            self._overdue.cancel()
            self._overdue = None

    def discard(self) -> None:
        """Throw away what no reply has claimed."""
        self._statistics.discarded += len(self.received)
        self.received.clear()

    def lost(self, why: str) -> None:
        """Note that the connection is gone."""
        if self.closed.is_set():
            return
        self.closed.set()
        self.outage = why
        self.answer(LinkLost(f"{self._name}: {why}"))

    def unasked(self) -> BadReply:
        """The complaint about octets that no request explains."""
        octets = bytes(self.received[:32]).hex(" ")
        return BadReply(f"{self._name}: octets nobody asked for: {octets}")

    def _time_out(self, timeout: float) -> None:
        self.answer(
            ReplyTimeout(
                f"{self._name} did not answer within {timeout * 1e3:g} ms:"
                f" {self._request}"
            )
        )


class Connector(Protocol[Q]):
    """Opens a line, again and again."""

    async def open(self) -> Line[Q]:
        """Open it now, or raise `LinkLost`."""
        ...
