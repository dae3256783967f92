"""What was refused, in the log: enough to see an attack, too little to be one."""

from collections import Counter
from collections.abc import Callable

import structlog

from gripperd.config.complaint import printable

EVERY = 10.0
"""A refusal of one kind is logged at most so often; those between are counted. [s]"""

log = structlog.get_logger()


class Refusals:
    """Logs refusals by their code.

    Parameters
    ----------
    now
        Monotonic time. [s]
    """

    def __init__(self, now: Callable[[], float]) -> None:
        self._now = now
        self._told: dict[str, float] = {}
        self._untold = Counter[str]()

    def note(self, code: str, detail: str) -> None:
        """Take in one refusal."""
        now = self._now()
        if now - self._told.get(code, -EVERY) < EVERY:
            self._untold[code] += 1
            return
        self._told[code] = now
        untold = self._untold.pop(code, 0)
        log.warning("refused", code=code, reason=printable(detail), untold=untold)
