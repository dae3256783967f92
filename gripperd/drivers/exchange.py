"""The record of one request and its reply."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias


@dataclass(frozen=True, slots=True, kw_only=True)
class Exchange:
    """One request as it went over the line, and what came of it."""

    time: float
    """When it was sent, on the monotonic clock. [s]"""
    request: bytes
    """What was sent, or would have been on a line that had not failed."""
    reply: bytes
    """All that came: a reply, a piece of one, or nothing."""
    error: str | None
    """Name of the error; None when the reply was believed."""


Trace: TypeAlias = Callable[[Exchange], None]
"""Is told every exchange on a bus, when it is over."""
