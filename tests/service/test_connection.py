"""Connections that wait, and more of them than there may be; over real sockets."""

import contextlib
import socket
import threading
from functools import partial
from urllib.parse import urlsplit

import httpx
from starlette.responses import PlainTextResponse
from starlette.types import Receive, Scope, Send

from gripperd.service.server import Limits, serve

from .conftest import Report, running

APP = PlainTextResponse("here")
PATIENCE = 60.0
"""Longest wait of a test, far above what is waited for. [s]"""


async def limited(limits: Limits, report: Report) -> None:
    await serve(APP, "127.0.0.1", 0, report, limits)


def serving(
    *, connections: int = 512, wait: float = PATIENCE * 2
) -> "contextlib.AbstractContextManager[str]":
    return running(partial(limited, Limits(connections=connections, wait=wait)))


def connected(url: str) -> socket.socket:
    place = urlsplit(url)
    assert place.port is not None
    return socket.create_connection(("127.0.0.1", place.port), timeout=PATIENCE)


def hung_up(client: socket.socket) -> bool:
    """Whether the server closes the connection, and says nothing."""
    try:
        return client.recv(1) == b""
    except ConnectionResetError:
        return True


def open_still(client: socket.socket) -> bool:
    client.sendall(b"GET / HTTP/1.1\r\nHost: a\r\n\r\n")
    return client.recv(4096).startswith(b"HTTP/1.1 200")


def test_who_never_asks_is_hung_up_on() -> None:
    with serving(wait=0.1) as url, connected(url) as client:
        assert hung_up(client)


def test_who_asks_a_letter_at_a_time_is_hung_up_on() -> None:
    with serving(wait=0.3) as url, connected(url) as client:
        with contextlib.suppress(BrokenPipeError, ConnectionResetError):
            for letter in b"GET / HTTP/1.1\r\nHost: a\r\nSlow: " + b"s" * 10_000:
                client.sendall(bytes([letter]))
        assert hung_up(client)


def test_the_wait_for_the_next_request_begins_with_the_last_answer() -> None:
    with serving(wait=2.0) as url, connected(url) as client:
        assert open_still(client)
        assert hung_up(client)


def test_the_newest_connection_takes_the_place_of_the_one_that_waits_longest() -> None:
    with serving(connections=3) as url, contextlib.ExitStack() as stack:
        clients = [stack.enter_context(connected(url)) for _ in range(3)]
        assert all(map(open_still, clients))
        # The first has just been heard; the second waits longest now.
        assert open_still(clients[0])
        newest = stack.enter_context(connected(url))
        assert open_still(newest)
        assert hung_up(clients[1])
        assert open_still(clients[0])
        assert open_still(clients[2])


def test_who_never_reads_is_hung_up_on() -> None:
    gone = threading.Event()

    async def talkative(scope: Scope, receive: Receive, send: Send) -> None:
        await send({"type": "http.response.start", "status": 200, "headers": []})
        # Far more than fits between the two.
        body = b"." * (1 << 24)
        await send({"type": "http.response.body", "body": body, "more_body": True})
        while (await receive())["type"] != "http.disconnect":
            pass
        gone.set()

    limits = Limits(stuck=0.2)
    with (
        running(lambda report: serve(talkative, "127.0.0.1", 0, report, limits)) as url,
        connected(url) as client,
    ):
        client.sendall(b"GET / HTTP/1.1\r\nHost: a\r\n\r\n")
        assert gone.wait(PATIENCE)


def test_hundreds_of_mute_connections_keep_nobody_out() -> None:
    with serving(connections=50) as url, contextlib.ExitStack() as stack:
        mute = [stack.enter_context(connected(url)) for _ in range(300)]
        assert httpx.get(url, timeout=PATIENCE).text == "here"
        assert hung_up(mute[0])
