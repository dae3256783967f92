"""A write and a read on a bus, against bare pymodbus, the same device behind both.

Ours runs on uvloop, as the daemon does. pymodbus keeps no silence between RTU frames:
it is compared with ours without; the silence of the specification stands below.
"""

import asyncio
import shutil
import time
from collections.abc import Awaitable, Callable, Mapping

import uvloop
from pymodbus.client import AsyncModbusSerialClient, AsyncModbusTcpClient
from rich.console import Group
from rich.table import Table

from gripperd.drivers.bus import RtuAddress, TcpAddress, open_bus
from gripperd.protocol.modbus import Read, Write
from gripperd.protocol.modbus import Table as Registers
from tests.benchmarks.device import BAUD, rtu_device, tcp_device
from tests.benchmarks.sample import median, p99

PAIRS = 2000
ROUNDS = 5
WARM_UP = 100

Contest = Mapping[str, Callable[[], list[float]]]


async def _timed(pair: Callable[[], Awaitable[object]], pairs: int) -> list[float]:
    for _ in range(WARM_UP):
        await pair()
    durations = []
    for _ in range(pairs):
        start = time.perf_counter()
        await pair()
        durations.append(time.perf_counter() - start)
    return durations


async def ours(address: TcpAddress | RtuAddress, pairs: int = PAIRS) -> list[float]:
    async with open_bus(address) as bus:
        await bus.up.wait()

        async def pair() -> None:
            await bus.ask(Write(1, 7, (4000,)))
            await bus.ask(Read(1, Registers.INPUT, 0, 8))

        await bus.ask(Read(1, Registers.INPUT, 0))
        return await _timed(pair, pairs)


async def pymodbus(
    client: Callable[[], AsyncModbusTcpClient | AsyncModbusSerialClient],
) -> list[float]:
    opened = client()
    assert await opened.connect()

    async def pair() -> None:
        await opened.write_register(7, 4000, device_id=1)
        await opened.read_input_registers(0, count=8, device_id=1)

    try:
        return await _timed(pair, PAIRS)
    finally:
        opened.close()


def over_tcp(host: str, port: int) -> Contest:
    address = TcpAddress(host=host, port=port, timeout=1.0)

    def client() -> AsyncModbusTcpClient:
        return AsyncModbusTcpClient(host, port=port, timeout=1.0, retries=0)

    return {
        "gripperd (uvloop)": lambda: uvloop.run(ours(address)),
        "pymodbus async (asyncio)": lambda: asyncio.run(pymodbus(client)),
        "pymodbus async (uvloop)": lambda: uvloop.run(pymodbus(client)),
    }


def over_rtu(port: str) -> Contest:
    # The time-out is also how long a port is listened to before it is used.
    bare = RtuAddress(port=port, baud=BAUD, timeout=0.5, silence=0.0)
    proper = RtuAddress(port=port, baud=BAUD, timeout=0.5)

    def client() -> AsyncModbusSerialClient:
        return AsyncModbusSerialClient(port, baudrate=BAUD, timeout=0.5, retries=0)

    return {
        "gripperd (uvloop), no silence": lambda: uvloop.run(ours(bare)),
        "pymodbus async (asyncio)": lambda: asyncio.run(pymodbus(client)),
        "pymodbus async (uvloop)": lambda: uvloop.run(pymodbus(client)),
        "gripperd (uvloop), 3.5 characters of silence": lambda: uvloop.run(
            ours(proper, PAIRS // 10)
        ),
    }


def _table(title: str, contest: Contest, goal: str) -> Table:
    durations: dict[str, list[float]] = {name: [] for name in contest}
    for _ in range(ROUNDS):
        for name, run in contest.items():
            durations[name] += run()
    found = Table(title, "pairs/s", "median", "p99", "ratio", "goal")
    first, yardstick, *_ = contest
    bare = median(durations[yardstick])
    goals = {first: goal, yardstick: "yardstick"}
    for name, taken in durations.items():
        middle = median(taken)
        found.add_row(
            name,
            f"{1 / middle:,.0f}",
            f"{middle * 1e6:.0f} µs",
            f"{p99(taken) * 1e6:.0f} µs",
            f"{middle / bare:.2f}x",
            goals.get(name, ""),
        )
    return found


def table() -> Group:
    with tcp_device() as (host, port):
        tcp = _table("write + read, TCP", over_tcp(host, port), "<= 0.7x")
    if shutil.which("socat") is None:
        return Group(tcp, "write + read, RTU: not measured, socat is missing")
    with rtu_device() as near:
        rtu = _table("write + read, RTU over ptys", over_rtu(near), "<= 0.8x")
    return Group(tcp, rtu)
