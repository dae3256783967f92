"""The watchdog protocol of systemd, the side that is watched.

References
----------
.. [1] sd_watchdog_enabled(3), sd_notify(3): ``WATCHDOG=1`` at least once in
   ``$WATCHDOG_USEC``.
"""

import os
import time
from collections.abc import Callable, Iterable, Mapping

from gripperd.cli.notify import notify

INTERVAL, OWNER = "WATCHDOG_USEC", "WATCHDOG_PID"
"""Variables: the longest silence [µs], and whose it is."""
SHARE = 4
"""It is fed so many times in the longest silence."""


def longest_silence(environment: Mapping[str, str] = os.environ) -> float | None:
    """Time after which this process counts as stalled, None if nobody watches. [s]."""
    owner = environment.get(OWNER)
    interval = environment.get(INTERVAL, "")
    if owner not in {None, str(os.getpid())} or not interval.isdecimal():
        return None
    return int(interval) / 1e6 or None


def feed() -> None:
    """Say that this process is well, if whoever listens has an ear free."""
    notify(WATCHDOG=1)


class Watchdog:
    """Fed by progress, never by a timer: a timer runs on while the work stands still.

    Parameters
    ----------
    names
        Who must advance, each of them.
    silence
        The longest that is allowed, None when nobody watches. [s]
    feed
        Feeds it.
    now
        The monotonic clock. [s]
    """

    def __init__(
        self,
        names: Iterable[str],
        silence: float | None,
        feed: Callable[[], None] = feed,
        now: Callable[[], float] = time.monotonic,
    ) -> None:
        self._names = frozenset(names)
        self._missing = set(self._names)
        self._pause = None if silence is None else silence / SHARE
        self._feed = feed
        self._now = now
        self._fed = now()

    def advanced(self, name: str) -> None:
        """One of them got something done."""
        self._missing.discard(name)
        if self._pause is None or self._missing:
            return
        if (now := self._now()) >= self._fed + self._pause:
            self._feed()
            self._fed = now
            self._missing = set(self._names)
