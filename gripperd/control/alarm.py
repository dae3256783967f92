"""Wakes a task at an absolute time, as exactly as the kernel can.

The timers of an event loop are rounded to a millisecond; a timerfd is not.

References
----------
.. [1] timerfd_create(2).
"""

import asyncio
import ctypes
import os
import time
from contextlib import suppress
from types import TracebackType
from typing import Self

NANO = 1_000_000_000
"""Nanoseconds in a second."""
ABSOLUTE = 1
"""TFD_TIMER_ABSTIME: the time to ring at, not the time until then."""

_libc = ctypes.CDLL(None, use_errno=True)


class Alarm:
    """An alarm clock on the monotonic clock, for one task of the running event loop.

    Raises
    ------
    OSError
        The process may open no more files.
    """

    def __init__(self) -> None:
        flags = os.O_NONBLOCK | os.O_CLOEXEC
        self._timer = _checked(_libc.timerfd_create(time.CLOCK_MONOTONIC, flags))
        self._rung: asyncio.Future[None] | None = None

    def __enter__(self) -> Self:
        asyncio.get_running_loop().add_reader(self._timer, self._ring)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        asyncio.get_running_loop().remove_reader(self._timer)
        os.close(self._timer)

    async def until(self, when: float) -> None:
        """Return at a time of the monotonic clock, or at once when it is past. [s]."""
        seconds, part = divmod(int(when * NANO), NANO)
        setting = (ctypes.c_long * 4)(0, 0, seconds, part)
        self._rung = asyncio.get_running_loop().create_future()
        _checked(_libc.timerfd_settime(self._timer, ABSOLUTE, setting, None))
        await self._rung

    def _ring(self) -> None:
        # Set anew meanwhile, there is nothing to read yet.
        with suppress(BlockingIOError):
            os.read(self._timer, 8)
            if self._rung is not None and not self._rung.done():
                self._rung.set_result(None)


def _checked(result: int) -> int:
    if result < 0:
        number = ctypes.get_errno()
        raise OSError(number, os.strerror(number))
    return result
