"""A line that is cut while an apple is held, and a stop that finds the bus busy.

The time-outs are those of the shipped settings. Writes are counted at the far end, from
the cut until commands are taken again.
"""

import tempfile
from pathlib import Path

import uvloop
from rich.console import Group
from rich.table import Table

from gripperd.protocol.modbus import WRITE_REGISTER
from tests.benchmarks.sample import median
from tests.control.far_rig import Fault, far_rig
from tests.control.outage import (
    QUEUED,
    Outage,
    controlled,
    hold,
    interrupt,
    stop_behind_reads,
)

SECONDS = 10.0
"""How long the line is cut. [s]"""
STOPS = 10
TIMEOUTS = {
    Fault.TCP_SILENT: 0.2,
    Fault.TCP_CLOSED: 0.2,
    Fault.RTU_SILENT: 0.25,
    Fault.RTU_UNPLUGGED: 0.25,
}


async def _cut(fault: Fault, folder: Path) -> tuple[Outage, int, int]:
    """The outage, and the output register before and after it. [µA]."""
    async with (
        far_rig(fault, folder, TIMEOUTS[fault]) as (bus, far),
        controlled(bus) as loop,
    ):
        await hold(loop, far)
        before = far.output
        outage = await interrupt(loop, far, SECONDS)
        return outage, before, far.output


async def _stop(fault: Fault, folder: Path) -> float:
    async with (
        far_rig(fault, folder, TIMEOUTS[fault]) as (bus, far),
        controlled(bus) as loop,
    ):
        after, heard = await stop_behind_reads(loop, bus, far)
        assert heard[0].pdu[0] == WRITE_REGISTER
        return after


def _outages(folder: Path) -> Table:
    found = Table(
        f"line cut for {SECONDS:g} s", "register", "writes", "offline", "ready again"
    )
    for fault, timeout in TIMEOUTS.items():
        outage, before, after = uvloop.run(_cut(fault, folder))
        writes = sum(asked.pdu[0] == WRITE_REGISTER for asked in outage.heard)
        found.add_row(
            f"{fault}; time-out {timeout * 1e3:g} ms",
            f"{before} -> {after} µA",
            f"{writes}",
            f"{outage.offline_after * 1e3:.0f} ms",
            f"{outage.ready_after * 1e3:.0f} ms",
        )
    found.add_row("goal", "as it was", "0", "<= 300 ms", "<= 2000 ms")
    return found


def _stops(folder: Path) -> Table:
    found = Table(f"stop, {QUEUED} reads waiting", "heard after the one in flight")
    for fault in (Fault.TCP_SILENT, Fault.RTU_SILENT):
        line, _, _ = fault.partition(",")
        taken = [uvloop.run(_stop(fault, folder)) for _ in range(STOPS)]
        found.add_row(
            line, f"median {median(taken) * 1e3:.1f}, longest {max(taken) * 1e3:.1f} ms"
        )
    return found


def table() -> Group:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        return Group(_outages(folder), _stops(folder))
