"""The history behind a thread of its own, opened again after the disk failed."""

import asyncio
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import TypeVar

import structlog

from gripperd.errors import Refused
from gripperd.service.event_documents import EventDocument, EventKind, event_record
from gripperd.service.rendering import timestamp
from gripperd.store.history import History

T = TypeVar("T")

REST = 1.0
"""Time for which a disk that failed is left alone. [s]"""
KEPT = 90 * 24 * 3600.0
"""How long commands, their keys and events are kept. [s]"""

log = structlog.get_logger()


class Archive:
    """One history for many tasks; the event loop never waits for the disk.

    Parameters
    ----------
    path
        The database file.
    now
        The clock, in seconds since the epoch.
    """

    def __init__(self, path: Path, now: Callable[[], float] = time.time) -> None:
        self.trouble: str | None = None
        """Why nothing can be kept now; None while all is well."""
        self._path = path
        self._now = now
        self._history: History | None = None
        self._failed: tuple[float, Refused] | None = None
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="archive")

    async def do(self, work: Callable[[History], T]) -> T:
        """Do something with the history; what was written is durable on return.

        Raises
        ------
        Refused
            The disk did not do it.
        """
        loop = asyncio.get_running_loop()
        return await loop.run_in_executor(self._thread, self._done, work)

    async def close(self) -> None:
        """Let go of the file, after what was begun."""
        await asyncio.to_thread(self._thread.shutdown)
        if self._history is not None:
            self._history.close()

    @property
    def damaged(self) -> tuple[str, ...]:
        """Records that were found damaged and are left out."""
        return () if self._history is None else tuple(sorted(self._history.damaged))

    def _done(self, work: Callable[[History], T]) -> T:
        if self._failed is not None and time.monotonic() < self._failed[0]:
            raise self._failed[1]
        try:
            history = self._opened()
            result = work(history)
        except Refused as error:
            self._fail(error)
            raise
        if self._failed is not None:
            self._recover(history)
        return result

    def _recover(self, history: History) -> None:
        """Find out whether the disk takes anything: a full one can still be read."""
        with suppress(Refused):
            history.prove()
            log.warning("the history is kept again", path=str(self._path))
            self._failed = self.trouble = None

    def _opened(self) -> History:
        if self._history is None:
            moment = datetime.fromtimestamp(self._now(), UTC).strftime("%Y%m%dT%H%M%SZ")
            self._history = History(self._path, moment)
            self._history.forget_before(self._now() - KEPT)
            aside = self._history.set_aside
            if aside is not None:
                text = f"a damaged history was set aside: {aside.path}: {aside.reason}"
                log.error(text)
                at = timestamp(self._now())
                event = EventDocument(at=at, kind=EventKind.STORAGE, text=text)
                self._history.put(told=[event_record(event)])
        return self._history

    def _fail(self, error: Refused) -> None:
        # Opened again, the file is checked; a damaged one is set aside.
        if self._history is not None:
            self._history.close()
            self._history = None
        if self._failed is None:
            log.error("nothing is kept", reason=str(error))
        self._failed = (time.monotonic() + REST, error)
        self.trouble = str(error)
