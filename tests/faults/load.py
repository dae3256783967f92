"""A service that is stalled, flooded or left waiting; control does not notice."""

import asyncio
import os
import resource
import signal
import socket
import threading
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from urllib.parse import urlsplit

import httpx

from gripperd.control.timing import Distribution
from gripperd.link.client import Client
from gripperd.link.control import Overview, ReadOverview
from gripperd.service.guard import LONGEST_BODY
from gripperd.service.server import LONGEST_STUCK
from tests.daemon import PATIENCE
from tests.faults.held import Held, held_egg
from tests.faults.row import Row

STALE = 0.5
"""Older measurements are not called fresh any more. [s]"""
STOP_WITHIN = 1.0
STALLED = 5.0
FLOODED = 5.0
"""How long a fault lasts. [s]"""
FLOODERS = 32
"""Clients that ask as fast as they are answered."""
MUTE = 10_000
"""Connections that say nothing, as far as this process may open so many files."""
SPARE_FILES = 500
EVENTS = 100
"""More than a reader that does not read has room for."""


@contextmanager
def told(held: Held, rows: list[Row], fault: str, noticed: str) -> Iterator[set[str]]:
    """Let a fault happen inside, and add how late control was meanwhile."""
    process = held.process("control")
    before, wrong = _lateness(held), set[str]()
    yield wrong
    meanwhile = _lateness(held).since(before)
    if held.process("control") != process:
        wrong.add("control was started anew")
    rows.append(
        Row(
            fault=fault,
            noticed=f"{noticed}; control late by",
            took=(meanwhile.largest,),
            limit=STALE,
            wrong=tuple(sorted(wrong | held.wrong())),
        )
    )


def _lateness(held: Held) -> Distribution:
    """How punctual control has been, asked past the service."""

    async def ask() -> Overview:
        client = Client(held.folder / "run" / "control.sock", "control")
        try:
            return await client.ask(ReadOverview(), Overview)
        finally:
            await client.close()

    return asyncio.run(ask()).timings["g0"].lateness


def stalled(held: Held, seconds: float = STALLED) -> list[Row]:
    """Stop the process of the service for a while, as a debugger does."""
    rows: list[Row] = []
    service = held.process("service")
    with told(held, rows, f"service stalled for {seconds:g} s", "goes on") as wrong:
        os.kill(service, signal.SIGSTOP)
        time.sleep(seconds)
        os.kill(service, signal.SIGCONT)
        start = time.monotonic()
        held.since(start, held.ready)
        if held.process("service") != service:
            wrong.add("the service was started anew")
    return rows


def flooded(held: Held, seconds: float = FLOODED) -> list[Row]:
    """Ask from many clients at once as fast as answers come, and stop meanwhile."""
    rows: list[Row] = []
    answers: Counter[str] = Counter()
    over = threading.Event()

    def ask() -> None:
        with httpx.Client(base_url=held.http.base_url, timeout=PATIENCE) as client:
            while not over.is_set():
                try:
                    found = client.get("/grippers/g0")
                    answers[f"{found.status_code}"] += 1
                except httpx.TransportError as error:
                    answers[type(error).__name__] += 1

    floods = [threading.Thread(target=ask) for _ in range(FLOODERS)]
    stops = []
    with told(held, rows, f"{FLOODERS} clients flood", "answered") as wrong:
        for each in floods:
            each.start()
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            stops.append(_stop(held))
            time.sleep(0.2)
        over.set()
        for each in floods:
            each.join()
        if unknown := set(answers) - {"200", "429", "503"}:
            wrong.add(f"answered {', '.join(sorted(unknown))}")
    rows.append(_stopped(f"{FLOODERS} clients flood", stops))
    return rows


def crowded(held: Held, mute: int = MUTE) -> list[Row]:
    """Stop on a new connection, among many that say nothing."""
    rows: list[Row] = []
    most = resource.getrlimit(resource.RLIMIT_NOFILE)[0] - SPARE_FILES
    count = min(mute, most)
    place = urlsplit(held.daemon.url)
    fault = f"{count} connections, mute"
    with told(held, rows, fault, "the oldest give way"), ExitStack() as stack:
        for _ in range(count):
            address = place.hostname, place.port
            stack.enter_context(socket.create_connection(address, 60.0))
        stops = [_stop(held)]
    rows.append(_stopped(fault, stops))
    return rows


def oversized(held: Held) -> list[Row]:
    """Send a body that is too large by an octet, and announce one that never ends."""
    rows: list[Row] = []
    with told(held, rows, "body of 64 KiB and more", "413") as wrong:
        body = b'"' + b"x" * (LONGEST_BODY - 1) + b'"'
        json = {"content-type": "application/json"}
        path = "/grippers/g0/commands"
        found = held.http.post(path, content=body, headers=json)
        if (found.status_code, found.json()["code"]) != (413, "body-too-large"):
            wrong.add(f"{found.status_code}")
        if b" 413 " not in _announced(held, path, 10**12):
            wrong.add("a terabyte is waited for")
    return rows


def _announced(held: Held, path: str, size: int) -> bytes:
    """First line of the answer to a request whose body only begins."""
    place = urlsplit(held.daemon.url)
    with socket.create_connection((place.hostname, place.port), 60.0) as line:
        head = (
            f"POST /v1{path} HTTP/1.1\r\nHost: localhost\r\n"
            f"Content-Type: application/json\r\nContent-Length: {size}\r\n\r\n"
        )
        line.sendall(head.encode() + b"x")
        return line.recv(4096).partition(b"\r\n")[0]


def unread(held: Held, events: int = EVENTS) -> list[Row]:
    """Follow the events, and read none of them."""
    rows: list[Row] = []
    place = urlsplit(held.daemon.url)
    fault = "reader of events that never reads"
    with told(held, rows, fault, "goes on"), socket.socket() as line:
        # What the kernel keeps for the reader must soon be full.
        line.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 2048)
        line.connect((place.hostname, place.port))
        line.sendall(b"GET /v1/events HTTP/1.1\r\nHost: localhost\r\n\r\n")
        start = time.monotonic()
        _happen(held, events)
        took = held.since(start, lambda: not _known(place.port, line.getsockname()[1]))
    dropped = Row(fault=fault, noticed="dropped", took=(took,), limit=2 * LONGEST_STUCK)
    return [*rows, dropped]


def _known(near: int | None, far: int) -> bool:
    """Whether the kernel knows an open connection from one port to another."""
    ends = f":{near:04X}", f":{far:04X}", "01"
    for entry in Path("/proc/net/tcp").read_text().splitlines():
        fields = entry.split()
        found = fields[1][-5:], fields[2][-5:], fields[3]
        if found == ends:
            return True
    return False


def _happen(held: Held, events: int) -> None:
    """Let something happen often: each lease begins and ends."""
    for _ in range(events // 2):
        lease = {"owner": "x" * 64, "ttl_s": 60}
        token = held.http.put("/grippers/g0/lease", json=lease).json()["token"]
        held.http.delete("/grippers/g0/lease", headers={"Lease-Token": token})


def _stop(held: Held) -> float:
    """Time for a stop on a connection of its own. [s]."""
    start = time.monotonic()
    url = f"{held.daemon.url}/v1/grippers/g0/stop"
    httpx.post(url, timeout=PATIENCE).raise_for_status()
    return time.monotonic() - start


def _stopped(fault: str, stops: list[float]) -> Row:
    return Row(
        fault=fault, noticed="a stop is answered", took=tuple(stops), limit=STOP_WITHIN
    )


def rows() -> Iterator[Row]:
    """Each on the same daemon, which holds an egg."""
    with held_egg() as held:
        for fault in (stalled, flooded, crowded, oversized, unread):
            yield from fault(held)
