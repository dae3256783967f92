"""What goes wrong on a line, told to bare pymodbus and to the bus owner of gripperd.

The device and its misdeeds are the same for both; so is the time-out. pymodbus has its
retries off, except where they are the subject.
"""

import asyncio
import logging
import tempfile
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from pymodbus.client import AsyncModbusSerialClient, AsyncModbusTcpClient
from pymodbus.exceptions import ModbusException
from pymodbus.pdu import ModbusPDU
from rich.console import Console
from rich.table import Table

from gripperd.drivers.bus import ModbusBus
from gripperd.errors import LinkError
from tests.drivers.far_end import (
    PATIENCE,
    Asked,
    FarEnd,
    RtuFarEnd,
    TcpFarEnd,
    dead,
    honest,
    once,
    over_rtu,
    over_tcp,
    plugged,
    read,
    write,
)
from tests.drivers.peer import listening


class Client(Protocol):
    """Says in words what became of a request."""

    @property
    def connected(self) -> bool: ...

    async def read(self, address: int, count: int = 1) -> str: ...
    async def write(self, value: int) -> str: ...


@dataclass(frozen=True)
class Ours:
    bus: ModbusBus

    @property
    def connected(self) -> bool:
        return self.bus.up.is_set()

    async def read(self, address: int, count: int = 1) -> str:
        return await self._told(self.bus.ask(read(address, count)))

    async def write(self, value: int) -> str:
        return await self._told(self.bus.ask(write(value)))

    async def _told(self, asking: Awaitable[tuple[int, ...]]) -> str:
        await self.bus.up.wait()
        try:
            return f"believed {list(await asking)}"
        except LinkError as error:
            return type(error).__name__


@dataclass(frozen=True)
class Pymodbus:
    client: AsyncModbusTcpClient | AsyncModbusSerialClient

    @property
    def connected(self) -> bool:
        return bool(self.client.connected)

    async def read(self, address: int, count: int = 1) -> str:
        return await self._told(
            lambda: self.client.read_holding_registers(
                address, count=count, device_id=1
            )
        )

    async def write(self, value: int) -> str:
        return await self._told(
            lambda: self.client.write_register(0, value, device_id=1)
        )

    async def _told(self, ask: Callable[[], Awaitable[ModbusPDU]]) -> str:
        try:
            reply = await ask()
        except ModbusException as error:
            return type(error).__name__
        return "error reply" if reply.isError() else f"believed {reply.registers}"


Scenario = Callable[[Client, FarEnd], Awaitable[str]]


def late(after: float) -> Callable[[FarEnd, Asked], None]:
    """Answer once so late, then in four fifths of the time-out."""
    loop = asyncio.get_running_loop()

    def slow(far: FarEnd, asked: Asked) -> None:
        loop.call_later(0.8 * PATIENCE, honest, far, asked)

    def first(far: FarEnd, asked: Asked) -> None:
        far.behave = slow
        loop.call_later(after, honest, far, asked)

    return first


async def late_read(client: Client, far: FarEnd) -> str:
    far.behave = late(1.5 * PATIENCE)
    await client.read(0)
    return await client.read(100)


async def very_late_read(client: Client, far: FarEnd) -> str:
    def both(far: FarEnd, asked: Asked) -> None:
        honest(far, far.asked[-2])
        honest(far, asked)

    far.behave = once(dead)
    await client.read(0)
    far.behave = both
    return await client.read(100)


async def late_echo(client: Client, far: FarEnd) -> str:
    far.behave = late(1.5 * PATIENCE)
    await client.write(10_700)
    return await client.read(100)


async def cancelled(client: Client, far: FarEnd) -> str:
    far.behave = late(0.5 * PATIENCE)
    asking = asyncio.create_task(client.read(0))
    await far.has(len(far.asked) + 1)
    asking.cancel()
    await asyncio.gather(asking, return_exceptions=True)
    return await client.read(100)


async def wrong_echo(client: Client, far: FarEnd) -> str:
    far.behave = once(lambda far, asked: far.reply(asked, asked.pdu[:3] + b"\0\1"))
    return await client.write(10_700)


async def short_read(client: Client, far: FarEnd) -> str:
    far.behave = once(lambda far, asked: far.reply(asked, b"\x03\x02\x00\x01"))
    return await client.read(0, 4)


async def wrong_function(client: Client, far: FarEnd) -> str:
    far.behave = once(lambda far, asked: far.reply(asked, b"\x04\x02\x00\x01"))
    return await client.read(0)


async def wrong_unit(client: Client, far: FarEnd) -> str:
    far.behave = once(lambda far, asked: far.reply(asked, b"\x03\x02\x00\x01", 2))
    return await client.read(0)


async def noise(client: Client, far: FarEnd) -> str:
    def noisy(far: FarEnd, asked: Asked) -> None:
        far.put(b"\x00\xff")
        honest(far, asked)

    far.behave = once(noisy)
    return f"{await client.read(0)}, then {await client.read(100)}"


async def own_echo(client: Client, far: FarEnd) -> str:
    far.behave = lambda far, asked: far.put(asked.frame)
    return f"read: {await client.read(0)}, write: {await client.write(10_700)}"


async def dead_device(client: Client, far: FarEnd) -> str:
    far.behave = dead
    before = len(far.asked)
    await client.write(10_700)
    return f"write sent {len(far.asked) - before} time(s)"


async def silent_peer(client: Client, far: FarEnd) -> str:
    far.behave = dead
    asked = 0
    while client.connected:
        await client.read(0)
        asked += 1
    return f"given up after {asked} request(s)"


BOTH: dict[str, Scenario] = {
    "reply 1.5 time-outs late, during the next read (1100 is right)": late_read,
    "echo of a write 1.5 time-outs late, during a read": late_echo,
    "read cancelled in flight, then another (1100 is right)": cancelled,
    "another value echoed": wrong_echo,
    "one register of four": short_read,
    "another function answers": wrong_function,
    "another unit answers": wrong_unit,
    "two octets of noise before the frame": noise,
    "dead device, default retries": dead_device,
}
RTU = BOTH | {
    "reply later than any silence, during the next read": very_late_read,
    "converter echoes, nobody is there": own_echo,
}
TCP = BOTH | {"peer falls silent": silent_peer}


@asynccontextmanager
async def _pymodbus_rtu(
    path: Path, retries: int
) -> AsyncIterator[tuple[Pymodbus, RtuFarEnd]]:
    async with plugged(path) as far:
        client = AsyncModbusSerialClient(
            str(path), baudrate=9600, timeout=PATIENCE, retries=retries
        )
        await client.connect()
        yield Pymodbus(client), far
        client.close()


@asynccontextmanager
async def _pymodbus_tcp(retries: int) -> AsyncIterator[tuple[Pymodbus, TcpFarEnd]]:
    async with listening(lambda line, frame: None) as peer:
        client = AsyncModbusTcpClient(
            "127.0.0.1", port=peer.port, timeout=PATIENCE, retries=retries
        )
        await client.connect()
        await peer.called(1)
        yield Pymodbus(client), TcpFarEnd(peer)
        client.close()


async def _rtu(scenario: Scenario, path: Path) -> tuple[str, str]:
    retries = 3 if scenario is dead_device else 0
    async with _pymodbus_rtu(path, retries) as (theirs, far):
        found = await scenario(theirs, far)
    async with over_rtu(path) as (bus, far):
        if scenario is not own_echo:
            await bus.ask(read(7))
        return found, await scenario(Ours(bus), far)


async def _tcp(scenario: Scenario) -> tuple[str, str]:
    retries = 3 if scenario is dead_device else 0
    async with _pymodbus_tcp(retries) as (theirs, far):
        found = await scenario(theirs, far)
    async with over_tcp(PATIENCE) as (bus, far):
        return found, await scenario(Ours(bus), far)


def table() -> Table:
    # What pymodbus logs of these misdeeds would drown the table.
    logging.getLogger("pymodbus").setLevel(logging.CRITICAL)
    found = Table("what goes wrong", "line", "pymodbus async", "gripperd")
    with tempfile.TemporaryDirectory() as folder:
        for name, scenario in RTU.items():
            outcomes = asyncio.run(_rtu(scenario, Path(folder) / "adapter"))
            found.add_row(name, "RTU", *outcomes)
    for name, scenario in TCP.items():
        found.add_row(name, "TCP", *asyncio.run(_tcp(scenario)))
    return found


if __name__ == "__main__":
    Console(width=140).print(table())
