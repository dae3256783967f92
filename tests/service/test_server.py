"""Starting and ending the web server."""

import socket

import httpx
import pytest
from starlette.responses import PlainTextResponse

from gripperd.errors import Refused
from gripperd.service.server import serve

from .conftest import Report, running

APP = PlainTextResponse("here")


async def _on_a_free_port(report: Report) -> None:
    await serve(APP, "127.0.0.1", 0, report)


def test_it_says_where_it_really_listens() -> None:
    with running(_on_a_free_port) as url:
        assert httpx.get(url).text == "here"
        assert not url.endswith(":0")


def test_nobody_listens_once_it_ended() -> None:
    with running(_on_a_free_port) as url:
        pass
    with pytest.raises(httpx.ConnectError):
        httpx.get(url)


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
