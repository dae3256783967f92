"""Who may use a bus next."""

import asyncio
from collections import deque


class Turns:
    """Mutual exclusion in which an urgent request passes all that wait."""

    def __init__(self) -> None:
        self._taken = False
        self._urgent: deque[asyncio.Future[None]] = deque()
        self._waiting: deque[asyncio.Future[None]] = deque()

    def take(self) -> bool:
        """Take the turn if nobody has it, and say whether it was taken."""
        if self._taken:
            return False
        self._taken = True
        return True

    async def wait(self, *, urgent: bool) -> None:
        """Return when it is the caller's turn, after whoever has it now."""
        queue = self._urgent if urgent else self._waiting
        turn: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        queue.append(turn)
        try:
            await turn
        except asyncio.CancelledError:
            if turn.done() and not turn.cancelled():
                self.give()
            elif turn in queue:
                queue.remove(turn)
            raise

    def give(self) -> None:
        """Hand the turn to the next in line."""
        for queue in (self._urgent, self._waiting):
            while queue:
                turn = queue.popleft()
                if not turn.done():
                    turn.set_result(None)
                    return
        self._taken = False
