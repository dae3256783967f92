"""Faults of the processes, of the whole daemon as a user runs it."""

import os
import signal
import socket
import tempfile
import time
from collections.abc import Iterator
from contextlib import ExitStack, suppress
from pathlib import Path
from urllib.parse import urlsplit

import httpx

from tests.daemon import Daemon, children, running_daemon, until
from tests.faults.row import Row

CONTROL_SILENCE, RESTART = 2.0, 10.0
"""The silence that the supervisor allows, and the time for a new start. [s]"""
MUTE = 3000
"""Connections that say nothing."""
STOP_WITHIN = 1.0
PATIENCE = 60.0


def _hold_an_egg(http: httpx.Client) -> None:
    http.put("/bench/object", json={"profile": "raw_egg"}).raise_for_status()
    answer = http.post(
        "/grippers/g0/commands",
        json={"type": "grasp", "profile": "raw_egg"},
        headers={"Prefer": "wait=30"},
    )
    assert answer.json()["status"] == "succeeded", answer.text


def _answers(http: httpx.Client) -> bool:
    with suppress(httpx.TransportError):
        return http.get("/health/ready").is_success
    return False


def _replaced(daemon: Daemon, name: str, old: int) -> bool:
    return children(daemon.process).get(name, old) != old


def _again(daemon: Daemon, http: httpx.Client, name: str, number: int) -> float:
    """Time from a signal to a process until a new one is ready. [s]."""
    old = children(daemon.process)[name]
    force = http.get("/bench").json()["force_N"]
    start = time.monotonic()
    os.kill(old, number)
    until(lambda: _replaced(daemon, name, old) and _answers(http), PATIENCE)
    took = time.monotonic() - start
    state, truth = http.get("/grippers/g0").json(), http.get("/bench").json()
    assert state["grip"] == "holding"
    assert abs(truth["force_N"] - force) < 0.02 * force
    return took


def _stop_in_a_crowd(daemon: Daemon) -> float:
    """Time for a stop on a new connection, among many that say nothing. [s]."""
    place = urlsplit(daemon.url)
    with ExitStack() as stack:
        for _ in range(MUTE):
            stack.enter_context(
                socket.create_connection((place.hostname, place.port), PATIENCE)
            )
        start = time.monotonic()
        httpx.post(
            f"{daemon.url}/v1/grippers/g0/stop", timeout=PATIENCE
        ).raise_for_status()
        return time.monotonic() - start


def rows() -> Iterator[Row]:
    """Each while an egg is held; its force must not change."""
    with (
        tempfile.TemporaryDirectory() as folder,
        running_daemon(Path(folder)) as daemon,
        httpx.Client(base_url=f"{daemon.url}/v1", timeout=PATIENCE) as http,
    ):
        _hold_an_egg(http)
        deaths: tuple[tuple[str, str, int, float], ...] = (
            ("control killed", "control", signal.SIGKILL, RESTART),
            ("control told to end", "control", signal.SIGTERM, RESTART),
            ("control stalled", "control", signal.SIGSTOP, CONTROL_SILENCE + RESTART),
            ("service killed", "service", signal.SIGKILL, RESTART),
        )
        for fault, name, number, limit in deaths:
            took = _again(daemon, http, name, number)
            yield Row(
                fault=f"{fault}, egg held",
                noticed="force unchanged, adopted, ready",
                took=(took,),
                limit=limit,
            )
        yield Row(
            fault=f"{MUTE} connections that say nothing",
            noticed="a stop is answered",
            took=(_stop_in_a_crowd(daemon),),
            limit=STOP_WITHIN,
        )
