"""What every open line has in common: a stream that is cut into replies."""

import asyncio
import time
from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Generic, Protocol, TypeAlias, TypeVar

from gripperd.drivers.statistics import BusStatistics
from gripperd.errors import BadReply, LinkError, LinkLost, ReplyTimeout

Q = TypeVar("Q")
"""A request."""

Cut: TypeAlias = Callable[[Q, bytes], int | None]
"""Length of the reply at the start of a buffer, see `Dialect.frame_length`."""

STALLED = 0.25
"""Share of its time by which nobody looked for a reply when it was due, from which the
peer has as long again. [-]"""


class Line(ABC, Generic[Q]):
    """One open connection, until it is lost or closed.

    Parameters
    ----------
    name
        Of the peer, for messages.
    timeout
        How long a reply may take. [s]
    cut
        Finds the end of a reply.
    statistics
        Counts what is thrown away.
    now
        A clock that never steps. [s]
    """

    def __init__(
        self,
        name: str,
        timeout: float,
        cut: Cut[Q],
        statistics: BusStatistics,
        now: Callable[[], float] = time.monotonic,
    ) -> None:
        self.closed = asyncio.Event()
        self.received = b""
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
        self._timeout = timeout
        self._now = now
        self._cut = cut
        self._statistics = statistics
        self._loop = asyncio.get_running_loop()
        self._request: Q
        self._reply: asyncio.Future[bytes] | None = None
        self._due = 0.0
        self._excused = False
        self._rings = 0.0
        self._alarm: asyncio.TimerHandle | None = None

    @abstractmethod
    def send(self, request: Q, octets: bytes) -> asyncio.Future[bytes]:
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

    def expect(self, request: Q) -> asyncio.Future[bytes]:
        """Wait for the reply to a request that is being sent."""
        self._request = request
        self._reply = self._loop.create_future()
        self._due = self._now() + self._timeout
        self._excused = False
        # One alarm serves many requests, as making one takes longer than telling time.
        if self._alarm is None:
            self._look_in(self._timeout)
        return self._reply

    def hear(self, octets: bytes) -> None:
        """Take what has come, and answer once the reply is complete."""
        self.received += octets
        reply = self._reply
        if reply is None:
            self.overhear()
            return
        try:
            length = self._cut(self._request, self.received)
        except LinkError as error:
            self.fail(error)
            return
        if length is None:
            return
        frame, self.received = self.received[:length], self.received[length:]
        self._reply = None
        # Who asked may have been cancelled a moment ago.
        if not reply.done():
            reply.set_result(frame)

    def fail(self, error: LinkError) -> None:
        """Tell who waits, if anybody does, that there will be no reply."""
        reply = self._reply
        self._reply = None
        if reply is not None and not reply.done():
            reply.set_exception(error)

    def forget(self) -> None:
        """Wait for nothing any more."""
        self._reply = None

    def discard(self) -> None:
        """Throw away what no reply has claimed."""
        self._statistics.discarded += len(self.received)
        self.received = b""

    def lost(self, why: str) -> None:
        """Note that the connection is gone."""
        if self.closed.is_set():
            return
        self.closed.set()
        self.outage = why
        self.fail(LinkLost(f"{self._name}: {why}"))

    def unasked(self) -> BadReply:
        """The complaint about octets that no request explains."""
        octets = self.received[:32].hex(" ")
        return BadReply(f"{self._name}: octets nobody asked for: {octets}")

    def _look_in(self, seconds: float) -> None:
        self._rings = self._now() + seconds
        self._alarm = self._loop.call_later(seconds, self._look_at_clock)

    def _look_at_clock(self) -> None:
        """Give up the reply that is waited for, or look again when it is due."""
        self._alarm = None
        if self._reply is None:
            return
        now = self._now()
        # What stalls this process may stall a peer on the same machine as well, such as
        # the bench. Once a request, or a busy one would wait for ever.
        if now - self._rings > STALLED * self._timeout and not self._excused:
            self._due, self._excused = now + self._timeout, True
        if now < self._due:
            self._look_in(self._due - now)
            return
        self.fail(
            ReplyTimeout(
                f"{self._name} did not answer within {self._timeout * 1e3:g} ms:"
                f" {self._request}"
            )
        )


class Connector(Protocol[Q]):
    """Opens a line, again and again."""

    async def open(self) -> Line[Q]:
        """Open it now, or raise `LinkLost`."""
        ...
