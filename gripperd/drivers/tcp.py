"""A Modbus TCP connection.

One that is spoiled is closed: a late reply to it cannot reach the next.
"""

import asyncio
import os
from functools import partial
from typing import Generic, TypeVar, cast

from gripperd.drivers.address import TcpAddress
from gripperd.drivers.line import Cut, Line
from gripperd.drivers.statistics import BusStatistics
from gripperd.errors import LinkLost

Q = TypeVar("Q")

CONNECT_WITHIN = 0.5
"""Longest wait for one attempt to connect. [s]"""
MOST_EVIDENCE = 4096
"""Octets kept that nobody asked for."""


class TcpLine(Line[Q], asyncio.Protocol):
    """An open TCP connection."""

    _transport: asyncio.Transport

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Asyncio has connected."""
        # uvloop has transports of its own that are no subclass.
        self._transport = cast("asyncio.Transport", transport)

    def data_received(self, data: bytes) -> None:
        """Asyncio has octets."""
        self.hear(data)

    def connection_lost(self, exc: Exception | None) -> None:
        """Asyncio has lost the peer."""
        self.lost("the peer closed the connection")

    def send(self, request: Q, octets: bytes) -> asyncio.Future[bytes]:
        """Put a request on the line, see :meth:`Line.send`."""
        if self._transport.is_closing():
            message = f"{self._name}: the peer has closed the connection"
            raise LinkLost(message)
        if self.received:
            raise self.unasked()
        self._transport.write(octets)
        return self.expect(request)

    def spoil(self) -> None:
        """Close, to be opened anew."""
        self.close("an earlier request went wrong; it is being opened anew")

    def overhear(self) -> None:
        """Keep them, as evidence: the next request is refused for them."""
        if len(self.received) > MOST_EVIDENCE:
            self.close("the peer floods the connection")

    def close(self, why: str = "the bus was closed") -> None:
        """Close now."""
        self.discard()
        self._transport.abort()
        self.lost(why)


class TcpConnector(Generic[Q]):
    """Opens connections to one address."""

    def __init__(
        self, address: TcpAddress, cut: Cut[Q], statistics: BusStatistics
    ) -> None:
        self._address = address
        self._line = partial(TcpLine, str(address), address.timeout, cut, statistics)

    async def open(self) -> Line[Q]:
        """Connect.

        Raises
        ------
        LinkLost
            Nobody is there.
        """
        address = self._address
        loop = asyncio.get_running_loop()
        try:
            async with asyncio.timeout(CONNECT_WITHIN):
                _, line = await loop.create_connection(
                    self._line, address.host, address.port
                )
        except TimeoutError as error:
            message = f"it does not answer within {CONNECT_WITHIN * 1e3:g} ms"
            raise LinkLost(message) from error
        except (OSError, ValueError) as error:
            raise LinkLost(_reason(error)) from error
        return line


def _reason(error: OSError | ValueError) -> str:
    """What went wrong, without the address that the caller names."""
    number = getattr(error, "errno", None)
    return os.strerror(number).lower() if number and number > 0 else str(error)
