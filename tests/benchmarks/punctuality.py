"""The control loop beside a service that is asked as fast as it answers.

Three arrangements: a process of its own with real-time priority, one without, and the
same loop inside the event loop of the service.
"""

import asyncio
import ctypes
import os
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from rich.table import Table

from gripperd.control.timing import Distribution
from gripperd.link.client import Client
from gripperd.link.control import Overview, ReadOverview
from tests.benchmarks.load import loaded
from tests.daemon import settings_file
from tests.parts import module, part

SECONDS = float(os.environ.get("SECONDS", "60"))
PR_CAPBSET_DROP, CAP_SYS_NICE = 24, 23
MILLI = 1e-3


def _without_real_time() -> None:
    """Make real-time priority out of reach, also for the super-user."""
    ctypes.CDLL(None).prctl(PR_CAPBSET_DROP, CAP_SYS_NICE, 0, 0, 0)


@contextmanager
def apart(folder: Path, before: Callable[[], None] | None) -> Iterator[str]:
    """Run the daemon as it is; the URL of its service."""
    quiet = subprocess.DEVNULL
    with part(settings_file(folder), "run", stderr=quiet, before=before) as run:
        yield run.facts["STATUS"].removeprefix("serving ")


@contextmanager
def together(folder: Path) -> Iterator[str]:
    """Run control and service in one event loop; the URL of the service."""
    config, quiet = settings_file(folder), subprocess.DEVNULL
    with (
        part(config, "bench", stderr=quiet) as bench,
        part(
            config,
            "together",
            bench.facts["ADDRESS"],
            program=module("tests.benchmarks.together"),
            stderr=quiet,
            before=_without_real_time,
            fact="ADDRESS",
        ) as both,
    ):
        yield both.facts["ADDRESS"]


async def _overview(folder: Path) -> Overview:
    client = Client(folder / "run" / "control.sock", "the control process")
    try:
        return await client.ask(ReadOverview(), Overview, 30.0)
    finally:
        await client.close()


def stolen() -> float:
    """Time that the host has taken from this machine so far, of all processors. [s]."""
    ticks = int(Path("/proc/stat").read_text().splitlines()[0].split()[8])
    return ticks / os.sysconf("SC_CLK_TCK")


@dataclass(frozen=True, slots=True)
class Measured:
    """One arrangement under load."""

    name: str
    real_time: bool
    lateness: Distribution
    overruns: int
    stolen: float
    """[s]"""


def measured(name: str, folder: Path, url: str) -> Measured:
    with loaded(url):
        time.sleep(1.0)
        before, taken = asyncio.run(_overview(folder)).timings["g0"], stolen()
        time.sleep(SECONDS)
        overview = asyncio.run(_overview(folder))
    after = overview.timings["g0"]
    return Measured(
        name,
        overview.real_time,
        after.lateness.since(before.lateness),
        after.overruns - before.overruns,
        stolen() - taken,
    )


def _rows() -> Iterator[Measured]:
    arrangements = (
        ("own process, real time", lambda folder: apart(folder, None)),
        ("own process", lambda folder: apart(folder, _without_real_time)),
        ("in the service's event loop", together),
    )
    for name, arranged in arrangements:
        with tempfile.TemporaryDirectory() as path:
            folder = Path(path)
            with arranged(folder) as url:
                yield measured(name, folder, url)


def table() -> Table:
    rows = list(_rows())
    worst = rows[-1].lateness.quantile(0.99) or 0.0
    title = f"lateness at 100 Hz, {SECONDS:g} s under load"
    heads = ("real time", "p50", "p99", "p99.9", "longest", "overruns", "stolen")
    found = Table(title, *heads, "p99 better", "goal")
    goals = (">= 20x, longest < 10 ms", ">= 2x", "yardstick")
    for row, goal in zip(rows, goals, strict=True):
        late = row.lateness
        points = [late.quantile(share) or 0.0 for share in (0.5, 0.99, 0.999)]
        found.add_row(
            row.name,
            "granted" if row.real_time else "no",
            *(f"{point / MILLI:.2f} ms" for point in points),
            f"{late.largest / MILLI:.1f} ms",
            f"{row.overruns}",
            f"{row.stolen / MILLI:.0f} ms",
            f"{worst / points[1]:.1f}x",
            goal,
        )
    return found
