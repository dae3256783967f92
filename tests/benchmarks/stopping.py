"""From POST stop to the confirmed write, while others ask 200 times a second."""

import os
import tempfile
import time
from contextlib import nullcontext
from pathlib import Path

import httpx
from rich.table import Table

from tests.benchmarks.load import loaded
from tests.benchmarks.sample import median, p99
from tests.daemon import Daemon, running_daemon

STOPS = int(os.environ.get("STOPS", "100"))
RATES = (0.0, 200.0)
"""Requests beside it. [1/s]"""
GRIPPER = "/v1/grippers/g0"
CLOSING = 0.25
"""A grasp moves the jaws by then. [s]"""


def stopping(daemon: Daemon) -> list[float]:
    """Durations from the request to the answer, which comes after the write. [s]."""
    durations = []
    with httpx.Client(base_url=daemon.url, timeout=20) as http:
        for _ in range(STOPS):
            body = {"type": "grasp", "profile": "grape"}
            http.post(f"{GRIPPER}/commands", json=body).raise_for_status()
            time.sleep(CLOSING)
            start = time.perf_counter()
            http.post(f"{GRIPPER}/stop").raise_for_status()
            durations.append(time.perf_counter() - start)
            _release(http)
    return durations


def _release(http: httpx.Client) -> None:
    while http.get(GRIPPER).json()["machine"] != "ready":
        time.sleep(0.05)
    http.post(
        f"{GRIPPER}/commands",
        json={"type": "release"},
        headers={"Prefer": "wait=20"},
    ).raise_for_status()


def table() -> Table:
    found = Table("POST stop, jaws closing", "median", "p99", "longest", "goal")
    with (
        tempfile.TemporaryDirectory() as folder,
        running_daemon(Path(folder)) as daemon,
    ):
        for rate in RATES:
            with loaded(daemon.url, rate) if rate else nullcontext():
                durations = stopping(daemon)
            found.add_row(
                f"beside {rate:g} requests/s",
                f"{median(durations) * 1e3:.1f} ms",
                f"{p99(durations) * 1e3:.1f} ms",
                f"{max(durations) * 1e3:.1f} ms",
                "median <= 10, p99 <= 30 ms",
            )
    return found
