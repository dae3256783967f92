"""Starting and ending the web server."""

import asyncio
import logging
import socket
from contextlib import ExitStack

import httpx
import pytest
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Receive, Scope, Send

from gripperd.errors import Refused
from gripperd.service.server import serve
from tests.daemon import PATIENCE

from .conftest import Report, running

APP = PlainTextResponse("here")


async def _on_a_free_port(report: Report) -> None:
    await serve(APP, "127.0.0.1", 0, report)


async def _mute(scope: Scope, receive: Receive, send: Send) -> None:
    """Begin an answer, and never go on."""
    await send({"type": "http.response.start", "status": 200, "headers": []})
    await send({"type": "http.response.body", "body": b"so", "more_body": True})
    await asyncio.Event().wait()


async def _talkative(scope: Scope, receive: Receive, send: Send) -> None:
    """Say more than anybody reads."""
    await send({"type": "http.response.start", "status": 200, "headers": []})
    while True:
        body = bytes(1 << 20)
        await send({"type": "http.response.body", "body": body, "more_body": True})


@pytest.mark.parametrize("app", [_mute, _talkative])
def test_at_its_end_it_hangs_up_on_who_is_still_being_answered(
    app: ASGIApp, caplog: pytest.LogCaptureFixture
) -> None:
    async def serving(report: Report) -> None:
        await serve(app, "127.0.0.1", 0, report)

    with ExitStack() as reading, running(serving) as url:
        reading.enter_context(httpx.stream("GET", url))
    assert [each for each in caplog.records if each.levelno >= logging.WARNING] == []


def test_it_says_where_it_really_listens() -> None:
    with running(_on_a_free_port) as url:
        assert httpx.get(url, timeout=PATIENCE).text == "here"
        assert not url.endswith(":0")


def test_nobody_listens_once_it_ended() -> None:
    with running(_on_a_free_port) as url:
        pass
    with pytest.raises(httpx.ConnectError):
        httpx.get(url, timeout=PATIENCE)


@pytest.mark.anyio
async def test_a_busy_port_is_one_clear_line() -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port: int = taken.getsockname()[1]
        with pytest.raises(Refused, match=f"http.port = {port}: another program"):
            await serve(APP, "127.0.0.1", port, print)


@pytest.mark.anyio
async def test_an_address_of_another_machine_is_refused() -> None:
    # 192.0.2.0/24 is for documentation (RFC 5737).
    with pytest.raises(Refused, match=r"http\.host = 192\.0\.2\.1"):
        await serve(APP, "192.0.2.1", 0, print)
