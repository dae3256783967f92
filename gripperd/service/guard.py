"""What a request must be before anybody looks into it.

A pure ASGI middleware. The host list is against DNS rebinding: a web page of a stranger
can make its own name point to this machine, and its requests then look local. The
origin check is against pages that simply send requests elsewhere; a browser says where
they come from.
"""

import asyncio
import re
import time
from collections.abc import Sequence

from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from gripperd.errors import Refused
from gripperd.service.problems import ProblemResponse, problem
from gripperd.service.refusals import Refusals

LONGEST_BODY = 64 * 1024
LONGEST_HEADERS = 16 * 1024
"""[octets]"""
BODY_TIME = 10.0
"""Longest time for a body to arrive. [s]"""
SCHEMES = ("http", "https")
"""Of its own pages; the second with a proxy in front of it."""
STREAMED = frozenset({("POST", "/v1/recordings")})
"""Bodies that are read as they come, by whoever answers."""
LOOPBACK = frozenset({"localhost", "127.0.0.1", "::1"})
HOST = re.compile(r"(?:\[([0-9a-f:.]+)\]|([0-9a-z._-]+))(?::[0-9]*)?", re.IGNORECASE)
"""An address or a name, and a port (RFC 9110, 7.2)."""
PRODUCED = frozenset(
    {
        "*/*",
        "application/*",
        "application/json",
        "application/problem+json",
        "text/event-stream",
    }
)


class Guard:
    """Refuses requests that are too large, too slow, misdirected or no JSON.

    Parameters
    ----------
    app
        What answers the others.
    host
        Where the service listens; requests may call it that, or by a loopback name.
    body_time
        Longest time for a body to arrive. [s]
    """

    def __init__(self, app: ASGIApp, host: str, body_time: float = BODY_TIME) -> None:
        self._app = app
        self._hosts = LOOPBACK | {host.lower()}
        self._body_time = body_time
        self._refusals = Refusals(time.monotonic)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer one request, or let it pass with its body read, if it is not large."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        send = _hardened(send)
        headers = Headers(scope=scope)
        try:
            self._check(scope, headers)
            streamed = (scope["method"], scope["path"]) in STREAMED
            body = b"" if streamed else await self._body(headers, receive)
        except Refused as refused:
            self._refusals.note(refused.code, str(refused))
            found = problem(
                refused.code,
                str(refused),
                instance=scope["path"],
                hints=refused.hints,
            )
            await ProblemResponse(found)(scope, receive, send)
            return
        read = receive if streamed else _replayed(body, receive)
        await self._app(scope, read, send)

    def _check(self, scope: Scope, headers: Headers) -> None:
        size = sum(len(name) + len(value) for name, value in headers.raw)
        if size > LONGEST_HEADERS:
            detail = f"{size} octets of headers; at most {LONGEST_HEADERS} are read"
            raise Refused(detail, code="headers-too-large")
        self._check_host(headers.getlist("host"))
        for origin in headers.getlist("origin"):
            _check_origin(origin, headers["host"])
        if scope["path"].startswith("/v1"):
            _check_accept(headers.getlist("accept"))

    def _check_host(self, hosts: Sequence[str]) -> None:
        if len(hosts) != 1:
            detail = f"{len(hosts)} Host headers; there must be one"
            raise Refused(detail, code="bad-request")
        if _name_of(hosts[0]) not in self._hosts:
            detail = f"this service is not called {hosts[0][:100]!r}"
            hints = (f"it is called: {', '.join(sorted(self._hosts))}",)
            raise Refused(detail, code="misdirected", hints=hints)

    async def _body(self, headers: Headers, receive: Receive) -> bytes:
        length = headers.get("content-length", "")
        if length.isdecimal() and int(length) > LONGEST_BODY:
            raise _too_large(f"has {length}")
        if length in {"", "0"} and "transfer-encoding" not in headers:
            return b""
        try:
            async with asyncio.timeout(self._body_time):
                body = await _read(receive)
        except TimeoutError:
            detail = f"the body was not complete within {self._body_time:g} s"
            raise Refused(detail, code="body-too-slow") from None
        if body:
            _check_json(headers)
        return body


def _name_of(host: str) -> str | None:
    found = HOST.fullmatch(host)
    return (found[1] or found[2]).lower() if found else None


def _check_origin(origin: str, host: str) -> None:
    """Refuse every page but this service's own; one at another port is a stranger's."""
    if origin.lower() not in {f"{scheme}://{host.lower()}" for scheme in SCHEMES}:
        detail = f"a page from {origin[:100]!r} may not talk to this service"
        raise Refused(detail, code="foreign-origin")


def _check_accept(accepts: Sequence[str]) -> None:
    ranges = [
        part.partition(";")[0].strip().lower()
        for accept in accepts
        for part in accept.split(",")
    ]
    if ranges and PRODUCED.isdisjoint(ranges):
        detail = f"{', '.join(ranges)[:100]} is not what there is: application/json"
        raise Refused(detail, code="not-acceptable")


def _check_json(headers: Headers) -> None:
    kind = headers.get("content-type", "").partition(";")[0].strip().lower()
    if kind != "application/json" and not (
        kind.startswith("application/") and kind.endswith("+json")
    ):
        detail = f"the body is {kind[:100] or 'of no stated type'}, not JSON"
        hints = ("send it with the header Content-Type: application/json",)
        raise Refused(detail, code="unsupported-media-type", hints=hints)
    coding = headers.get("content-encoding", "identity").lower()
    if coding != "identity":
        detail = f"a body with the content coding {coding[:100]!r} is not read"
        raise Refused(detail, code="unsupported-media-type")


def _too_large(size: str) -> Refused:
    detail = f"a body may have up to {LONGEST_BODY} octets; this one {size}"
    return Refused(detail, code="body-too-large")


async def _read(receive: Receive) -> bytes:
    body = bytearray()
    more = True
    while more:
        message = await receive()
        body += message.get("body", b"")
        more = message.get("more_body", False)
        if len(body) > LONGEST_BODY:
            raise _too_large(f"has {len(body)} or more")
    return bytes(body)


def _replayed(body: bytes, receive: Receive) -> Receive:
    """Give the body that was read, then what really comes."""
    given = False

    async def replay() -> Message:
        nonlocal given
        if given:
            return await receive()
        given = True
        return {"type": "http.request", "body": body, "more_body": False}

    return replay


def _hardened(send: Send) -> Send:
    """Tell browsers not to guess types, and nobody to keep a state for later."""

    async def harden(message: Message) -> None:
        if message["type"] == "http.response.start":
            headers = MutableHeaders(scope=message)
            headers["x-content-type-options"] = "nosniff"
            headers.setdefault("cache-control", "no-store")
        await send(message)

    return harden
