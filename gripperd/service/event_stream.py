"""Events as they happen, as server-sent events (HTML standard, section 9.2)."""

import asyncio
from collections.abc import AsyncIterator, Sequence
from contextlib import suppress

from fastapi.sse import KEEPALIVE_COMMENT, format_sse_event
from starlette.responses import Response
from starlette.types import Receive, Scope, Send

from gripperd.errors import Refused
from gripperd.service.archive import Archive
from gripperd.service.broadcast import Broadcast, Reader
from gripperd.service.event_documents import EventDocument, kept_event
from gripperd.store.history import EventQuery, EventRecord

QUIET = 15.0
"""Longest silence; then a comment shows that the line is alive. [s]"""
SLOWEST = 10.0
"""A reader that has not taken an event by then is dropped. [s]"""
PAGE = 200
"""Events that are read from the disk at once."""


class EventStream(Response):
    """Every event after a number, then those that come, until the reader leaves.

    Parameters
    ----------
    archive, broadcast
        Where the past and the present come from.
    after
        Number of the last event that the reader has; None for the present only.
    quiet, slowest
        See :data:`QUIET` and :data:`SLOWEST`. [s]
    """

    media_type = "text/event-stream"

    def __init__(
        self,
        archive: Archive,
        broadcast: Broadcast,
        after: int | None,
        *,
        quiet: float = QUIET,
        slowest: float = SLOWEST,
    ) -> None:
        super().__init__()
        # How long it is, nobody knows yet.
        del self.headers["content-length"]
        self._archive = archive
        self._broadcast = broadcast
        self._after = after
        self._quiet = quiet
        self._slowest = slowest

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Send until the reader leaves, is too slow, or the service ends."""
        start = {"type": "http.response.start", "status": 200}
        await send({**start, "headers": self.raw_headers})
        sending = asyncio.create_task(self._send(send))
        leaving = asyncio.create_task(_left(receive))
        try:
            await asyncio.wait({sending, leaving}, return_when=asyncio.FIRST_COMPLETED)
        finally:
            sending.cancel()
            leaving.cancel()
            await asyncio.gather(sending, leaving, return_exceptions=True)

    async def _send(self, send: Send) -> None:
        body = {"type": "http.response.body"}
        with suppress(TimeoutError, Refused):
            async for chunk in self._chunks():
                async with asyncio.timeout(self._slowest):
                    await send({**body, "body": chunk, "more_body": True})
        with suppress(TimeoutError):
            async with asyncio.timeout(self._slowest):
                await send({**body, "body": b"", "more_body": False})

    async def _chunks(self) -> AsyncIterator[bytes]:
        yield KEEPALIVE_COMMENT
        # Who listens before reading misses nothing in between.
        with self._broadcast.reader() as reader:
            last = 0
            async for kept in self._past():
                last = kept.number or last
                yield _chunk(kept)
            async for event in self._present(reader):
                if event is None:
                    yield KEEPALIVE_COMMENT
                elif event.number is None or event.number > last:
                    yield _chunk(event)

    async def _past(self) -> AsyncIterator[EventDocument]:
        after = self._after
        while after is not None:
            found = await self._page(EventQuery(after=after, limit=PAGE))
            for record in found:
                yield kept_event(record)
            after = found[-1].number if len(found) == PAGE else None

    async def _page(self, query: EventQuery) -> Sequence[EventRecord]:
        return await self._archive.do(lambda history: history.events(query))

    async def _present(self, reader: Reader) -> AsyncIterator[EventDocument | None]:
        while True:
            try:
                async with asyncio.timeout(self._quiet):
                    event = await reader.next()
            except TimeoutError:
                yield None
                continue
            if event is None:
                return
            yield event


async def _left(receive: Receive) -> None:
    while (await receive())["type"] != "http.disconnect":
        pass


def _chunk(event: EventDocument) -> bytes:
    number = None if event.number is None else str(event.number)
    return format_sse_event(
        data_str=event.model_dump_json(), event=event.kind, id=number
    )
