"""The newest exchanges on a bus, kept while somebody watches."""

import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from gripperd.drivers.exchange import Exchange, Trace

KEPT = 1000
"""Exchanges kept for a watcher that is late: seconds of the fastest bus."""
FORGOTTEN_AFTER = 5.0
"""Nobody watches who has not looked for so long. [s]"""


@dataclass(frozen=True, slots=True)
class Heard:
    """An exchange, with its place among all that were heard."""

    number: int
    """From 1, without gaps while somebody watches."""
    ended: float
    """When the reply was judged, or given up, on the monotonic clock. [s]"""
    exchange: Exchange


class Traced(Protocol):
    """A bus, as far as this goes."""

    trace: Trace | None
    """Is told every exchange."""


class Traffic:
    """Listens to a bus from the first look until nobody has looked for a while.

    Parameters
    ----------
    bus
        Which; while nobody watches, its trace is empty and costs nothing.
    now
        A clock that never steps. [s]
    """

    def __init__(self, bus: Traced, now: Callable[[], float] = time.monotonic) -> None:
        self._bus = bus
        self._now = now
        self._kept: deque[Heard] = deque(maxlen=KEPT)
        self._count = 0
        self._looked = 0.0

    def since(self, number: int) -> tuple[Heard, ...]:
        """Every exchange kept that came after one; the first look is empty."""
        self._looked = self._now()
        if self._bus.trace is None:
            self._bus.trace = self._hear
        return tuple(heard for heard in self._kept if heard.number > number)

    def _hear(self, exchange: Exchange) -> None:
        now = self._now()
        if now - self._looked > FORGOTTEN_AFTER:
            self._bus.trace = None
            self._kept.clear()
            return
        self._count += 1
        self._kept.append(Heard(self._count, now, exchange))
