"""A write and a read on a bus, against bare pymodbus, the same device behind both.

Ours runs on uvloop, as the daemon does. pymodbus keeps no silence between RTU frames:
it is compared with ours without; the silence of the specification stands below. The
floor sends the same octets and blocks until as many as expected are back, unread.

They take turns, many times: what else the machine does meets all of them. On an idle
machine client and device sleep on a processor each, and waking those takes most of the
time, of everybody alike; on a busy one, or on one processor, they wake each other.
"""

import asyncio
import os
import shutil
import socket
import time
from collections.abc import Awaitable, Callable, Mapping, Sequence
from itertools import chain

import uvloop
from pymodbus.client import AsyncModbusSerialClient, AsyncModbusTcpClient
from rich.console import Group
from rich.table import Table

from gripperd.drivers.address import RtuAddress, TcpAddress
from gripperd.drivers.bus import open_bus
from gripperd.drivers.serial_port import open_port
from gripperd.protocol.mbap import ModbusTcp
from gripperd.protocol.modbus import Read, Write
from gripperd.protocol.modbus import Table as Registers
from gripperd.protocol.rtu import ModbusRtu
from tests.benchmarks.device import BAUD, rtu_device, tcp_device
from tests.benchmarks.sample import median, p99, repeated

PAIRS = 500
ROUNDS = 20
WARM_UP = 50

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


def floor(descriptor: int, dialect: ModbusTcp | ModbusRtu) -> list[float]:
    exchanges: list[tuple[bytes, int]] = []
    for request, values in (
        (Write(1, 7, (4000,)), ()),
        (Read(1, Registers.INPUT, 0, 8), (0,) * 8),
    ):
        octets = dialect.encode(request, 1)
        exchanges.append((octets, len(dialect.encode_reply(octets, request, values))))

    def pair() -> None:
        for octets, awaited in exchanges:
            os.write(descriptor, octets)
            while awaited > 0:
                awaited -= len(os.read(descriptor, awaited))

    repeated(pair, WARM_UP)
    return repeated(pair, PAIRS)


def floor_over_tcp(host: str, port: int) -> list[float]:
    with socket.create_connection((host, port)) as opened:
        opened.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        return floor(opened.fileno(), ModbusTcp())


def floor_over_rtu(address: RtuAddress) -> list[float]:
    with open_port(address) as opened:
        os.set_blocking(opened.fileno(), True)
        return floor(opened.fileno(), ModbusRtu())


def over_tcp(host: str, port: int) -> Contest:
    address = TcpAddress(host=host, port=port, timeout=1.0)

    def client() -> AsyncModbusTcpClient:
        return AsyncModbusTcpClient(host, port=port, timeout=1.0, retries=0)

    return {
        "gripperd (uvloop)": lambda: uvloop.run(ours(address)),
        "pymodbus async (asyncio)": lambda: asyncio.run(pymodbus(client)),
        "pymodbus async (uvloop)": lambda: uvloop.run(pymodbus(client)),
        "floor: a bare blocking socket": lambda: floor_over_tcp(host, port),
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
        "floor: a bare blocking descriptor": lambda: floor_over_rtu(bare),
    }


def _ratios(rounds: Sequence[list[float]], yardstick: Sequence[list[float]]) -> str:
    """From the best round to the worst, each against the yardstick in the same."""
    pairs = zip(rounds, yardstick, strict=True)
    ratios = sorted(median(taken) / median(bare) for taken, bare in pairs)
    return f"{ratios[0]:.2f} to {ratios[-1]:.2f}x"


def _table(title: str, contest: Contest, goal: str) -> Table:
    rounds: dict[str, list[list[float]]] = {name: [] for name in contest}
    before = os.getloadavg()[0]
    for _ in range(ROUNDS):
        for name, run in contest.items():
            rounds[name].append(run())
    after = os.getloadavg()[0]
    found = Table(title, "pairs/s", "median", "p99", "ratio", "by round", "goal")
    found.caption = (
        f"load average {before:.1f} before, {after:.1f} after,"
        f" on {len(os.sched_getaffinity(0))} of {os.cpu_count()} processors"
    )
    first, yardstick, *_ = contest
    bare = median([*chain(*rounds[yardstick])])
    goals = {first: goal, yardstick: "yardstick"}
    for name, each in rounds.items():
        taken = [*chain(*each)]
        middle = median(taken)
        found.add_row(
            name,
            f"{1 / middle:,.0f}",
            f"{middle * 1e6:.0f} µs",
            f"{p99(taken) * 1e6:.0f} µs",
            f"{middle / bare:.2f}x",
            _ratios(each, rounds[yardstick]),
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
