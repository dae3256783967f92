"""Tells every reader what happens; one that does not keep up is dropped."""

import asyncio
from collections.abc import Iterator
from contextlib import contextmanager

from gripperd.service.event_documents import EventDocument

LONGEST = 256
"""Events that wait for one reader; one that is further behind comes back later."""
MOST_READERS = 64


class Reader:
    """The events that one client has not had yet."""

    def __init__(self) -> None:
        self._waiting: asyncio.Queue[EventDocument | None] = asyncio.Queue(LONGEST)
        self._dropped = False

    async def next(self) -> EventDocument | None:
        """The next event; None when there will be no more."""
        return None if self._dropped else await self._waiting.get()

    def tell(self, event: EventDocument) -> None:
        """Take an event, or stop reading when there is no room for it."""
        try:
            self._waiting.put_nowait(event)
        except asyncio.QueueFull:
            self._dropped = True

    def end(self) -> None:
        """Let the reader go when it has read what it has."""
        if self._waiting.full():
            self._dropped = True
        else:
            self._waiting.put_nowait(None)


class Broadcast:
    """Everybody who listens."""

    def __init__(self) -> None:
        self._readers: set[Reader] = set()

    @property
    def full(self) -> bool:
        """Whether nobody else may listen."""
        return len(self._readers) >= MOST_READERS

    @contextmanager
    def reader(self) -> Iterator[Reader]:
        """A reader of everything that happens while inside."""
        reader = Reader()
        self._readers.add(reader)
        try:
            yield reader
        finally:
            self._readers.discard(reader)

    def tell(self, event: EventDocument) -> None:
        """Tell everybody; nobody is waited for."""
        for reader in self._readers:
            reader.tell(event)

    def end(self) -> None:
        """Let everybody go."""
        for reader in self._readers:
            reader.end()
