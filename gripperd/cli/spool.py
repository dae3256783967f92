"""Log lines on their way out, so that who logs never waits for who reads."""

import os
import threading
from queue import Empty, Full, Queue

LENGTH = 1000
"""Lines that may wait, some 100 kB."""


class Spool:
    """A text stream that never blocks: a thread passes on what was written.

    What finds it full is dropped, counted, and told as soon as there is room again.

    Parameters
    ----------
    descriptor
        Of the open file that the lines go to.
    length
        Pieces of text that may wait.
    """

    def __init__(self, descriptor: int, length: int = LENGTH) -> None:
        self.dropped = 0
        """Pieces of text that nobody will read."""
        self._descriptor = descriptor
        self._waiting: Queue[str | None] = Queue(length)
        self._told = 0
        self._thread = threading.Thread(target=self._pass_on, name="log", daemon=True)
        self._thread.start()

    def write(self, text: str) -> int:
        """Take a piece of text; it is written, or dropped, later."""
        try:
            self._waiting.put_nowait(text)
        except Full:
            self.dropped += 1
        return len(text)

    def flush(self) -> None:
        """Wait for nothing: that is the point."""

    def close(self, within: float) -> None:
        """Give what waits a last chance. [s]."""
        try:
            self._waiting.put(None, timeout=within)
        except Full:
            return
        self._thread.join(within)

    def _pass_on(self) -> None:
        while (text := self._next()) is not None:
            try:
                _write_all(self._descriptor, text.encode(errors="replace"))
            except OSError:
                # Nobody will ever read it; the daemon has more important things to do.
                self.dropped += 1

    def _next(self) -> str | None:
        """What to write next; None at the end."""
        try:
            return self._waiting.get_nowait()
        except Empty:
            pass
        if missing := self.dropped - self._told:
            self._told += missing
            return f"{missing} log lines were dropped: they were not read in time\n"
        return self._waiting.get()


def _write_all(descriptor: int, octets: bytes) -> None:
    while octets:
        octets = octets[os.write(descriptor, octets) :]
