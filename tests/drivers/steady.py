"""Time-outs that a stall of the whole machine does not use up.

Where both ends of a line live in one event loop, a stall keeps the far end from
answering as well as this end from listening. A pseudo terminal may stall on its own:
a thread of the kernel passes its octets on, and waits for a processor as all do.
"""

import asyncio
import os
import time
import tty
import weakref
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from gripperd.drivers.bus import Bus
from gripperd.drivers.line import Connector, Line

MOST = 2e-3
"""By which the clock moves on at most, from one turn to the next. [s]"""


class Clock:
    """Goes on as real time does, but at most by `MOST` while an octet is on its way.

    It has crossed a pseudo terminal, and the event loop, when the next one sets out.
    None does once the line is closed: then time goes on as it does.
    """

    def __init__(self, line: Line[Any]) -> None:
        self._line = line
        self._loop = asyncio.get_running_loop()
        self._time = self._real = time.monotonic()
        self._near, self._far = os.openpty()
        self._closing = [
            weakref.finalize(self, os.close, end) for end in (self._near, self._far)
        ]
        tty.setraw(self._far)
        self._loop.add_reader(self._far, self._tick)
        self._send()

    def now(self) -> float:
        gone = time.monotonic() - self._real
        return self._time + (gone if self._line.closed.is_set() else min(gone, MOST))

    def _tick(self) -> None:
        """Begin a turn, and another one soon, as long as the line is open."""
        os.read(self._far, 1)
        self._time, self._real = self.now(), time.monotonic()
        if self._line.closed.is_set():
            self._loop.remove_reader(self._far)
            for close in self._closing:
                close()
        else:
            self._loop.call_later(MOST / 2, self._send)

    def _send(self) -> None:
        os.write(self._near, b"\0")


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
