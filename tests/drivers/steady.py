"""Time-outs that a stall of the whole machine does not use up.

Where both ends of a line live in one event loop, a stall keeps the far end from
answering as well as this end from listening.
"""

import asyncio
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from gripperd.drivers.bus import Bus
from gripperd.drivers.line import Connector, Line

MOST = 2e-3
"""By which the clock moves on between two turns of the event loop at most. [s]"""


class Clock:
    """Goes on as real time does, but at most by `MOST` in one turn of the loop."""

    def __init__(self, line: Line[Any]) -> None:
        self._line = line
        self._loop = asyncio.get_running_loop()
        self._time = self._real = time.monotonic()
        self._tick()

    def now(self) -> float:
        return self._time + min(time.monotonic() - self._real, MOST)

    def _tick(self) -> None:
        """Begin a turn, and another one soon, as long as the line is open."""
        self._time, self._real = self.now(), time.monotonic()
        if not self._line.closed.is_set():
            self._loop.call_later(MOST / 2, self._tick)


class Steadied:
    """Opens the lines of another connector, each with a clock of its own."""

    def __init__(self, connector: Connector[Any]) -> None:
        self._connector = connector

    async def open(self) -> Line[Any]:
        line = await self._connector.open()
        line._now = Clock(line).now
        return line


def steady(bus: Bus[Any, Any]) -> None:
    """Let no stall use up the time-outs of a bus from now on."""
    if not isinstance(bus._connector, Steadied):
        bus._connector = Steadied(bus._connector)
        if bus._line is not None:
            bus._line._now = Clock(bus._line).now


@contextmanager
def unsteady(bus: Bus[Any, Any]) -> Iterator[None]:
    """Go by the clock of the far end inside, which keeps a reply for so long."""
    line = bus._line
    assert line is not None
    line._now = time.monotonic
    try:
        yield
    finally:
        line._now = Clock(line).now
