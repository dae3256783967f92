"""How long the whole daemon takes to become ready, and what it keeps in memory.

The share of memory counts a page that several processes have as a part for each.
"""

import tempfile
import time
from pathlib import Path

from rich.table import Table

from tests.benchmarks.sample import median
from tests.daemon import children, gripperd, running_daemon, until

STARTS = 5
KIB_PER_MIB = 1024
PROCESSES = ("run", "bench", "control", "service")


def memory(pid: int) -> tuple[float, float]:
    """Resident memory of a process, and its share of it. [MiB, MiB]."""
    lines = Path(f"/proc/{pid}/smaps_rollup").read_text().splitlines()[1:]
    rows = dict(line.split(":", 1) for line in lines)
    resident, share = (int(rows[key].split()[0]) for key in ("Rss", "Pss"))
    return resident / KIB_PER_MIB, share / KIB_PER_MIB


def start() -> tuple[float, dict[str, tuple[float, float]]]:
    """Time from the command to its last line, and the memory of each process."""
    with tempfile.TemporaryDirectory() as folder:
        since = time.perf_counter()
        with running_daemon(Path(folder)) as daemon:
            ready = time.perf_counter() - since
            until(lambda: len(children(daemon.process)) == len(PROCESSES) - 1)
            pids = {"run": daemon.process.pid, **children(daemon.process)}
            return ready, {name: memory(pid) for name, pid in pids.items()}


def table() -> Table:
    # What every command of the program takes, before it does anything.
    since = time.perf_counter()
    gripperd("--version")
    least = time.perf_counter() - since
    starts = [start() for _ in range(STARTS)]
    result = Table("start", "median", "yardstick", title="Footprint")
    ready = median([seconds for seconds, _ in starts])
    result.add_row("run to ready", f"{ready:.2f} s", f"--version: {least:.2f} s")
    found = starts[-1][1]
    for name in PROCESSES:
        resident, share = found[name]
        result.add_row(name, f"{resident:.0f} MiB resident", f"share {share:.0f} MiB")
    total = sum(share for _, share in found.values())
    result.add_row("together", f"{total:.0f} MiB", "goal 150 MiB a process")
    return result
