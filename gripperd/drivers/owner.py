"""The one owner of a bus: one request at a time, nothing believed unchecked.

After a timeout, a cancellation or a reply that does not fit, no request goes out until
no late reply can answer it: a TCP connection is opened anew, a serial line drained. A
request is sent once; who wants to try again says so.
"""

import asyncio
import time
from collections.abc import Callable
from typing import Generic, TypeVar

from gripperd.drivers.address import Address
from gripperd.drivers.exchange import Exchange, Trace
from gripperd.drivers.line import Connector, Line
from gripperd.drivers.presence import Presence
from gripperd.drivers.statistics import BusStatistics
from gripperd.drivers.turns import Turns
from gripperd.errors import DeviceRefused, LinkError, LinkLost
from gripperd.protocol.dialect import Dialect

FIRST_BACK_OFF = 0.1
LAST_BACK_OFF = 0.5
"""Pause between attempts to open a line, doubled from the first to the last. [s]"""

Q = TypeVar("Q")
"""A request."""
R = TypeVar("R")
"""What a believed reply says."""


class Bus(Generic[Q, R]):
    """The one owner of a line. Make it with `open_bus`.

    Parameters
    ----------
    address
        Where the line is found.
    dialect
        What is spoken on it.
    connector
        Opens it.
    statistics
        Where its figures are kept.
    trace
        Is told every exchange.
    """

    def __init__(
        self,
        address: Address,
        dialect: Dialect[Q, R],
        connector: Connector[Q],
        statistics: BusStatistics,
        trace: Trace | None = None,
    ) -> None:
        self.address = address
        self.statistics = statistics
        self.trace = trace
        self.up = asyncio.Event()
        """Set while the line is open."""
        self._dialect = dialect
        self._connector = connector
        self._turns = Turns()
        self._line: Line[Q] | None = None
        self._outage = "it was not opened yet"
        self._draining: asyncio.Task[None] | None = None
        self._sequence = 0
        self._now = time.monotonic
        self._presence = Presence(str(address))

    async def ask(self, request: Q | Callable[[], Q], *, urgent: bool = False) -> R:
        """Send one request, once, and return its checked reply.

        Behind n others it ends within (n + 1) times ``address.longest_turn``; an urgent
        one is behind the request in flight and other urgent ones alone.

        Parameters
        ----------
        request
            What to ask; a function is asked when its turn has come.
        urgent
            Go before everything that waits, after the request in flight.

        Returns
        -------
        What the reply says.

        Raises
        ------
        LinkLost
            There is no connection, and it is being opened anew meanwhile; or nothing
            was read on a serial line yet, which could be echoing what is written.
        ReplyTimeout
            No reply in time; the request may or may not have been carried out.
        BadReply
            A reply that does not fit the request, or a line that is never silent.
        DeviceRefused
            The device answered with an exception; the line is sound.
        """
        if not self._turns.take():
            await self._turns.wait(urgent=urgent)
        try:
            return await self._exchange(request() if callable(request) else request)
        finally:
            self._pass_on()

    async def _exchange(self, request: Q) -> R:
        line = self._line
        if line is None:
            message = f"no connection to {self.address}: {self._outage}"
            raise LinkLost(message)
        self._sequence = sequence = self._sequence % 0xFFFF + 1
        octets = self._dialect.encode(request, sequence)
        if not line.proved:
            self._refuse_what_an_echo_confirms(request, sequence, octets)
        frame = b""
        sent = self._now()
        try:
            if line.halting:
                await line.pause()
                sent = self._now()
            self.statistics.requests += 1
            frame = await line.send(request, octets)
            answer = self._dialect.decode(request, sequence, frame)
        except BaseException as error:
            reply = frame or line.received
            if isinstance(error, DeviceRefused):
                self._presence.answers()
            self._count(line, error)
            self._tell(sent, octets, reply, error)
            raise
        line.proved = True
        self._presence.answers()
        self.statistics.latency.add(self._now() - sent)
        self._tell(sent, octets, frame, None)
        return answer

    def _refuse_what_an_echo_confirms(
        self, request: Q, sequence: int, octets: bytes
    ) -> None:
        """Refuse a write whose own echo would be believed, until a read has been."""
        try:
            self._dialect.decode(request, sequence, octets)
        except LinkError:
            return
        message = (
            f"nothing was read from {self.address} since it was opened, so that the"
            f" echo of '{request}' could pass for its reply; read first"
        )
        raise LinkLost(message)

    def _tell(
        self, sent: float, request: bytes, reply: bytes, error: BaseException | None
    ) -> None:
        if self.trace is None:
            return
        name = None if error is None else type(error).__name__
        self.trace(Exchange(time=sent, request=request, reply=reply, error=name))

    def _count(self, line: Line[Q], error: BaseException) -> None:
        self.statistics.errors[type(error).__name__] += 1
        if isinstance(error, DeviceRefused):
            return
        # Cancelled in flight, a misfit reply or a lost peer: what comes next could
        # answer the wrong question.
        if line.closed.is_set():
            self._lose(line)
            return
        line.spoil()
        if line.closed.is_set():
            self._drop(line)

    def _lose(self, line: Line[Q]) -> None:
        """Note that the peer has gone, if nobody has yet."""
        if line is self._line:
            self._drop(line)
            self._presence.lost(self._outage)

    def _drop(self, line: Line[Q]) -> None:
        self.up.clear()
        self._outage = line.outage
        self._line = None

    def _pass_on(self) -> None:
        """Give the turn to the next; a spoiled line keeps it until it is drained."""
        line = self._line
        if line is None or not line.spoiled:
            self._turns.give()
            return
        self._draining = asyncio.create_task(line.drain(), name=f"drain {self.address}")
        self._draining.add_done_callback(lambda _: self._turns.give())

    async def supervise(self) -> None:
        """Open the line, and open it again after every loss, for ever."""
        pause = FIRST_BACK_OFF
        while True:
            try:
                line = await self._connector.open()
            except LinkLost as error:
                self._outage = str(error)
                self._presence.lost(self._outage)
                self.statistics.errors["connect"] += 1
                await asyncio.sleep(pause)
                pause = min(2 * pause, LAST_BACK_OFF)
                continue
            pause = FIRST_BACK_OFF
            self.statistics.connections += 1
            self._line = line
            self.up.set()
            await line.closed.wait()
            self._lose(line)
            # A peer that accepts and hangs up at once must not be stormed.
            await asyncio.sleep(FIRST_BACK_OFF)

    def close(self) -> None:
        """Close the line, if there is one."""
        if self._line is not None:
            self._line.close()
            self._drop(self._line)
