"""The guard, over real sockets."""

import socket
from collections.abc import Iterator

import httpx
import pytest
from starlette.responses import PlainTextResponse

from gripperd.service.guard import Guard
from gripperd.service.server import serve
from tests.daemon import PATIENCE

from .conftest import Daemon, Report, running
from .test_bad_input import COMMANDS, JSON, is_problem

LIVE = "/v1/health/live"


def raw(daemon: Daemon, octets: bytes) -> bytes:
    """Send octets as they are and read one answer."""
    host, port = daemon.http.base_url.host, daemon.http.base_url.port
    assert port is not None
    with socket.create_connection((host, port)) as line:
        line.sendall(octets)
        answer = b""
        while b"\r\n\r\n" not in answer or not answer.endswith(b"}\n"):
            answer += line.recv(65536)
        return answer


def test_fifty_megabytes_are_refused(daemon: Daemon) -> None:
    answer = daemon.http.post(COMMANDS, content=b" " * 50_000_000, headers=JSON)
    found = is_problem(answer, 413, "body-too-large")
    assert "65536" in found["detail"]


def test_a_large_body_is_refused_before_it_is_sent(daemon: Daemon) -> None:
    head = (
        f"POST {COMMANDS} HTTP/1.1\r\nHost: localhost\r\n"
        "Content-Type: application/json\r\nContent-Length: 50000000\r\n\r\n"
    )
    assert raw(daemon, head.encode()).startswith(b"HTTP/1.1 413")


def test_a_body_without_a_length_is_counted(daemon: Daemon) -> None:
    def endless() -> Iterator[bytes]:
        for _ in range(400):
            yield b" " * 65536

    answer = daemon.http.post(COMMANDS, content=endless(), headers=JSON)
    is_problem(answer, 413, "body-too-large")


def test_the_largest_body_is_read(daemon: Daemon) -> None:
    body = b'{"type": "nothing"}'.ljust(65536)
    is_problem(daemon.http.post(COMMANDS, content=body, headers=JSON), 422, "invalid")
    body = b'{"type": "nothing"}'.ljust(65537)
    answer = daemon.http.post(COMMANDS, content=body, headers=JSON)
    is_problem(answer, 413, "body-too-large")


@pytest.mark.parametrize(
    "host", ["localhost", "LOCALHOST:80", "127.0.0.1", "[::1]:8765", "127.0.0.1:1"]
)
def test_its_own_names_are_served(daemon: Daemon, host: str) -> None:
    assert daemon.http.get(LIVE, headers={"host": host}).status_code == 200


@pytest.mark.parametrize(
    "host",
    [
        "evil.example",
        "localhost.evil.example",
        "a[b",
        "127.0.0.1.nip.io",
        "",
        "10.0.0.1",
        "local\thost",
        "x@localhost",
        "localhost/",
        "localhost:80:80",
    ],
)
def test_a_foreign_name_is_not_served(daemon: Daemon, host: str) -> None:
    answer = daemon.http.get(LIVE, headers={"host": host})
    is_problem(answer, 421, "misdirected")


@pytest.mark.parametrize("hosts", ["", "Host: localhost\r\nHost: localhost\r\n"])
def test_there_is_exactly_one_host_header(daemon: Daemon, hosts: str) -> None:
    answer = raw(daemon, f"GET {LIVE} HTTP/1.1\r\n{hosts}\r\n".encode())
    assert answer.startswith(b"HTTP/1.1 400")
    assert b"there must be one" in answer


@pytest.mark.parametrize("origin", ["http://evil.example", "null", "file://"])
def test_a_foreign_page_cannot_move_the_gripper(daemon: Daemon, origin: str) -> None:
    where = "/v1/grippers/g0/disable"
    answer = daemon.http.post(where, headers={"origin": origin})
    is_problem(answer, 403, "foreign-origin")
    assert daemon.http.get("/v1/grippers/g0").json()["machine"] == "ready"


@pytest.mark.parametrize(
    ("host", "origin", "status"),
    [
        ("localhost:8765", "http://localhost:8765", 200),
        ("LOCALHOST:8765", "http://localhost:8765", 200),
        ("[::1]:8765", "http://[::1]:8765", 200),
        ("localhost", "http://localhost", 200),
        # Another program of this machine, and its pages, are strangers too.
        ("localhost:8765", "http://localhost:3000", 403),
        ("localhost:8765", "http://127.0.0.1:8765", 403),
        ("localhost:8765", "http://localhost", 403),
        ("localhost:8765", "http://[", 403),
        ("localhost:8765", "http://local\thost:8765", 403),
        ("localhost:8765", "http://localhost:8765/page", 403),
        ("localhost:8765", "ftp://localhost:8765", 403),
    ],
)
def test_only_its_own_page_may_ask(
    daemon: Daemon, host: str, origin: str, status: int
) -> None:
    headers = {"host": host, "origin": origin}
    assert daemon.http.get(LIVE, headers=headers).status_code == status


@pytest.mark.parametrize(
    "headers",
    [
        {"content-type": "application/x-www-form-urlencoded"},
        {"content-type": "text/plain"},
        {},
        JSON | {"content-encoding": "gzip"},
    ],
)
def test_a_body_must_be_declared_json(daemon: Daemon, headers: dict[str, str]) -> None:
    answer = daemon.http.post(COMMANDS, content=b'{"type":"release"}', headers=headers)
    is_problem(answer, 415, "unsupported-media-type")


@pytest.mark.parametrize("accept", ["application/xml", "text/csv, image/png"])
def test_what_it_cannot_produce_is_not_acceptable(daemon: Daemon, accept: str) -> None:
    answer = daemon.http.get("/v1/info", headers={"accept": accept})
    is_problem(answer, 406, "not-acceptable")


@pytest.mark.parametrize(
    "accept", ["application/json", "text/html, */*;q=0.8", "application/problem+json"]
)
def test_what_it_produces_is_acceptable(daemon: Daemon, accept: str) -> None:
    assert daemon.http.get("/v1/info", headers={"accept": accept}).status_code == 200


def test_headers_have_an_end(daemon: Daemon) -> None:
    answer = daemon.http.get(LIVE, headers={"x-long": "a" * 20_000})
    is_problem(answer, 431, "headers-too-large")


def test_browsers_are_told_not_to_guess_nor_to_keep(daemon: Daemon) -> None:
    for path in (LIVE, "/nothing"):
        headers = daemon.http.get(path).headers
        assert headers["x-content-type-options"] == "nosniff"
        assert headers["cache-control"] == "no-store"


async def _impatient(report: Report) -> None:
    app = Guard(PlainTextResponse("reached"), "127.0.0.1", body_time=0.05)
    await serve(app, "127.0.0.1", 0, report)


def test_a_body_that_never_comes_is_given_up() -> None:
    head = (
        b"POST / HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
        b"Content-Length: 20\r\n\r\n{"
    )
    with (
        running(_impatient) as url,
        httpx.Client(base_url=url, timeout=PATIENCE) as http,
    ):
        answer = raw(Daemon(url, http), head)
        assert answer.startswith(b"HTTP/1.1 408")
        assert b'"code": "body-too-slow"' in answer


def test_a_request_that_ends_early_does_no_harm(daemon: Daemon) -> None:
    host, port = daemon.http.base_url.host, daemon.http.base_url.port
    head = (
        f"POST {COMMANDS} HTTP/1.1\r\nHost: localhost\r\n"
        "Content-Type: application/json\r\nContent-Length: 18\r\n\r\n"
    )
    before = daemon.http.get(COMMANDS).json()
    with socket.create_connection((host, port or 0)) as line:
        line.sendall(head.encode() + b'{"type":')
    assert daemon.http.get(COMMANDS).json() == before
