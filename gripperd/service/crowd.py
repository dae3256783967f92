"""No more requests at a time than can be answered soon; a stop is always answered."""

from asyncio import CancelledError

from starlette.types import ASGIApp, Receive, Scope, Send

from gripperd.service.problems import ProblemResponse, problem

MOST_REQUESTS = 256
"""A few times more than clients that wait for commands and listen to events."""


class Crowd:
    """Refuses requests while too many are being answered. A pure ASGI middleware.

    Parameters
    ----------
    app
        What answers the others.
    most
        How many it answers at a time.
    """

    def __init__(self, app: ASGIApp, most: int = MOST_REQUESTS) -> None:
        self._app = app
        self._most = most
        self._present = 0

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer one request, or refuse it at once."""
        if self._present >= self._most and not _stops(scope):
            await self._refuse(scope, receive, send)
            return
        self._present += 1
        try:
            await self._app(scope, receive, send)
        except CancelledError:
            # The server ends, and has hung up; it would log this as a defect.
            pass
        finally:
            self._present -= 1

    async def _refuse(self, scope: Scope, receive: Receive, send: Send) -> None:
        detail = f"{self._most} requests are being answered; no more at a time"
        found = problem("overloaded", detail, instance=scope["path"])
        response = ProblemResponse(found)
        # What is left of its body would be waited for.
        response.headers["connection"] = "close"
        await response(scope, receive, send)


def _stops(scope: Scope) -> bool:
    path: str = scope["path"]
    return scope["method"] == "POST" and path.endswith("/stop")
