"""A write and a read on the bus, against pymodbus, both with the bench as the peer."""

import asyncio
import tempfile
import time
from collections.abc import Awaitable, Callable
from pathlib import Path

import uvloop
from pymodbus.client import AsyncModbusTcpClient
from rich.table import Table

from gripperd.drivers.bus import TcpAddress, open_bus
from gripperd.protocol.modbus import Read, Write
from gripperd.protocol.modbus import Table as Registers
from tests.benchmarks.sample import median, p99
from tests.daemon import running_daemon

PAIRS = 3000
ROUNDS = 3


async def _timed(pair: Callable[[], Awaitable[object]]) -> list[float]:
    durations = []
    for _ in range(PAIRS):
        start = time.perf_counter()
        await pair()
        durations.append(time.perf_counter() - start)
    return durations


async def ours(host: str, port: int) -> list[float]:
    async with open_bus(TcpAddress(host=host, port=port, timeout=1.0)) as bus:
        await bus.up.wait()

        async def pair() -> None:
            await bus.ask(Write(1, 7, (4000,)))
            await bus.ask(Read(2, Registers.INPUT, 0, 8))

        return await _timed(pair)


async def pymodbus(host: str, port: int) -> list[float]:
    client = AsyncModbusTcpClient(host, port=port, timeout=1.0, retries=0)
    await client.connect()

    async def pair() -> None:
        await client.write_register(7, 4000, device_id=1)
        await client.read_input_registers(0, count=8, device_id=2)

    try:
        return await _timed(pair)
    finally:
        client.close()


def table() -> Table:
    durations: dict[str, list[float]] = {"ours": [], "asyncio": [], "uvloop": []}
    with (
        tempfile.TemporaryDirectory() as folder,
        running_daemon(Path(folder)) as daemon,
    ):
        for _ in range(ROUNDS):
            durations["ours"] += uvloop.run(ours(*daemon.bench))
            durations["asyncio"] += asyncio.run(pymodbus(*daemon.bench))
            durations["uvloop"] += uvloop.run(pymodbus(*daemon.bench))
    found = Table(
        "write + read pair, Modbus TCP", "pairs/s", "median", "p99", "ratio", "goal"
    )
    bare = median(durations["asyncio"])
    for name, label, goal in (
        ("ours", "gripperd (uvloop)", "<= 0.7x"),
        ("asyncio", "pymodbus async (asyncio)", "yardstick"),
        ("uvloop", "pymodbus async (uvloop)", ""),
    ):
        middle = median(durations[name])
        found.add_row(
            label,
            f"{1 / middle:,.0f}",
            f"{middle * 1e6:.0f} µs",
            f"{p99(durations[name]) * 1e6:.0f} µs",
            f"{middle / bare:.2f}x",
            goal,
        )
    return found
