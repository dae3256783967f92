"""An answer that everybody who asks within a moment shares."""

import asyncio
import time
from collections.abc import Callable, Coroutine
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class _Asked(Generic[T]):
    since: float
    answer: asyncio.Task[T]


class Shared(Generic[T]):
    """Asks on behalf of many, so that a flood of requests does not reach control.

    Parameters
    ----------
    ask
        Gets the answer for a name.
    lasting
        How long an answer is shared, counted from the question. [s]
    now
        A monotonic clock.
    """

    def __init__(
        self,
        ask: Callable[[str], Coroutine[Any, Any, T]],
        lasting: float,
        now: Callable[[], float] = time.monotonic,
    ) -> None:
        self._ask = ask
        self._lasting = lasting
        self._now = now
        self._asked: dict[str, _Asked[T]] = {}

    async def get(self, name: str) -> T:
        """Answer for a name; raises what asking raises."""
        asked = self._asked.get(name)
        if asked is None or self._now() - asked.since >= self._lasting:
            asked = _Asked(self._now(), asyncio.create_task(self._ask(name)))
            self._asked[name] = asked
        # A client that goes away must not take the answer from the others.
        return await asyncio.shield(asked.answer)

    def forget(self, name: str) -> None:
        """Ask anew from here on: something was changed."""
        self._asked.pop(name, None)
