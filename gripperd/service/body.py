"""Bodies of requests: strict JSON, known keys only, no guessing between types."""

import json
from collections.abc import Callable, Coroutine
from json import JSONDecodeError
from typing import Any

from fastapi import APIRouter, Request, Response
from fastapi.routing import APIRoute
from pydantic_core import PydanticCustomError

from gripperd.config.complaint import printable

DISAGREEMENT = "disagreement"
"""Type of the error when values exclude each other; its message says it all."""


def disagreement(message: str) -> PydanticCustomError:
    """Make the error to raise when values exclude each other."""
    return PydanticCustomError(DISAGREEMENT, message)


class _Repeated(ValueError):
    def __init__(self, key: str) -> None:
        super().__init__(f'"{printable(key)}" stands twice in one object')
        self.key = key


class StrictRequest(Request):
    """A request whose JSON says everything once and is UTF-8."""

    async def json(self) -> Any:  # noqa: ANN401 - whatever the client sent
        """Parse the body.

        Raises
        ------
        JSONDecodeError
            With the place of what cannot be read.
        """
        return parsed(await self.body())


def parsed(body: bytes) -> object:
    """Read strict JSON; numbers that are not finite are left to the schema.

    Raises
    ------
    JSONDecodeError
        With the place of what cannot be read.
    """
    try:
        text = body.decode()
    except UnicodeDecodeError as error:
        read = body[: error.start].decode()
        problem = "not UTF-8 text"
        raise JSONDecodeError(problem, read, len(read)) from error
    try:
        return json.loads(text, object_pairs_hook=_once)
    except JSONDecodeError:
        raise
    except _Repeated as error:
        place = max(text.rfind(json.dumps(error.key)), 0)
        raise JSONDecodeError(str(error), text, place) from error
    except RecursionError as error:
        problem = "nested too deeply"
        raise JSONDecodeError(problem, text, 0) from error
    except ValueError as error:
        problem = "a number has too many digits"
        raise JSONDecodeError(problem, text, 0) from error


def _once(pairs: list[tuple[str, object]]) -> dict[str, object]:
    found = dict(pairs)
    if len(found) < len(pairs):
        seen: set[str] = set()
        for key, _ in pairs:
            if key in seen:
                raise _Repeated(key)
            seen.add(key)
    return found


class Route(APIRoute):
    """A route that reads strict JSON, and writes it as a line."""

    def get_route_handler(
        self,
    ) -> Callable[[Request], Coroutine[Any, Any, Response]]:
        """Put the strict request in front of the handler."""
        answer = super().get_route_handler()

        async def strictly(request: Request) -> Response:
            return _ended(await answer(StrictRequest(request.scope, request.receive)))

        return strictly


def _ended(response: Response) -> Response:
    """End a JSON text as a line, so that a shell's prompt starts on its own."""
    # A 204 has no text that could end.
    if response.body and response.headers["content-type"] == "application/json":
        response.body = bytes(response.body) + b"\n"
        response.headers["content-length"] = str(len(response.body))
    return response


def router(tag: str) -> APIRouter:
    """Make a router of one kind of resource; strict, as every one must be."""
    return APIRouter(route_class=Route, tags=[tag])
