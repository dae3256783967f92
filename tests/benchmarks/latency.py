"""From POST to the register of the output module."""

import tempfile
import threading
import time
from pathlib import Path

import httpx
from pyModbusTCP.client import ModbusClient
from rich.table import Table

from tests.benchmarks.sample import median, p99
from tests.daemon import Daemon, running_daemon

GRASPS = 40


class Watcher(threading.Thread):
    """Reads the register without pause and notes when it changes."""

    def __init__(self, host: str, port: int) -> None:
        super().__init__(daemon=True)
        self.client = ModbusClient(host=host, port=port, unit_id=1)
        self.changed = threading.Event()
        self.at = 0.0
        self.waiting_for_change_from: int | None = None

    def register(self) -> int:
        registers = self.client.read_holding_registers(0, 1)
        assert registers is not None
        return int(registers[0])

    def run(self) -> None:
        before = self.register()
        self.changed.clear()
        while self.register() == before:
            pass
        self.at = time.perf_counter()
        self.changed.set()


def latency(daemon: Daemon, http: httpx.Client, body: dict[str, object]) -> float:
    """Time from the request to the first new value in the register. [s]."""
    watcher = Watcher(*daemon.bench)
    watcher.start()
    time.sleep(0.05)
    start = time.perf_counter()
    if body:
        http.post("/v1/grippers/g0/commands", json=body).raise_for_status()
    else:
        http.post("/v1/grippers/g0/stop").raise_for_status()
    watcher.join(5)
    assert watcher.changed.is_set()
    return watcher.at - start


def table() -> Table:
    grasps, stops = [], []
    with (
        tempfile.TemporaryDirectory() as folder,
        running_daemon(Path(folder)) as daemon,
        httpx.Client(base_url=daemon.url, timeout=20) as http,
    ):
        for _ in range(GRASPS):
            grasps.append(latency(daemon, http, {"type": "grasp", "profile": "apple"}))
            time.sleep(0.3)
            start = time.perf_counter()
            http.post("/v1/grippers/g0/stop").raise_for_status()
            stops.append(time.perf_counter() - start)
            time.sleep(0.4)
            http.post(
                "/v1/grippers/g0/commands",
                json={"type": "release"},
                headers={"Prefer": "wait=5"},
            ).raise_for_status()
    found = Table("request to register", "median", "p99", "goal")
    for name, durations, goal in (
        ("POST grasp -> first current written", grasps, ""),
        (
            "POST stop -> answered, after the write is confirmed",
            stops,
            "<= 10, p99 30 ms",
        ),
    ):
        found.add_row(
            name,
            f"{median(durations) * 1e3:.1f} ms",
            f"{p99(durations) * 1e3:.1f} ms",
            goal,
        )
    return found
