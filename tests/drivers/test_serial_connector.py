"""A serial port that is plugged in and out, taken, deaf or slow."""

import asyncio
import os
import threading
from collections.abc import Awaitable, Callable
from contextlib import suppress
from pathlib import Path

import pytest
import serial
from structlog.testing import capture_logs

from gripperd.drivers.bus import (
    RtuAddress,
    SerialAddress,
    open_bus,
)
from gripperd.drivers.serial_connector import SerialConnector
from gripperd.drivers.serial_port import open_port
from gripperd.drivers.statistics import BusStatistics
from gripperd.errors import LinkLost
from gripperd.protocol.rtu import ModbusRtu

from .far_end import (
    PATIENCE,
    dead,
    over_rtu,
    plugged,
    read,
    write,
)
from .peer import SOON, up
from .steady import steady

Eventually = Callable[[Callable[[], bool]], Awaitable[None]]


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "adapter"


async def test_after_a_replug_a_write_waits_again(
    path: Path, eventually: Eventually
) -> None:
    async with over_rtu(path) as (bus, far):
        await bus.ask(read(0))
        far.unplug()
        await eventually(lambda: not bus.up.is_set())
        with pytest.raises(LinkLost, match="no connection to"):
            await bus.ask(read(0))
        far.plug()
        await up(bus)
        with pytest.raises(LinkLost, match="read first"):
            await bus.ask(write(4000))
        assert await bus.ask(read(0)) == (1000,)
        assert await bus.ask(write(4000)) == (4000,)
        assert bus.statistics.connections == 2


async def test_a_request_in_flight_ends_when_the_adapter_is_unplugged(
    path: Path,
) -> None:
    async with over_rtu(path, patience=10 * PATIENCE) as (bus, far):
        far.behave = dead
        asking = asyncio.create_task(bus.ask(read(0)))
        await far.has(1)
        far.unplug()
        with pytest.raises(LinkLost, match="gone"):
            await asking
        assert not bus.up.is_set()


async def test_an_adapter_that_is_plugged_in_later_is_found(
    path: Path, eventually: Eventually
) -> None:
    async with open_bus(RtuAddress(port=str(path), timeout=PATIENCE)) as bus:
        steady(bus)
        await eventually(lambda: bus.statistics.errors["connect"] > 0)
        with pytest.raises(LinkLost, match=r"adapter does not exist; is the adapter"):
            await bus.ask(read(0))
        async with plugged(path):
            await up(bus)
            assert await bus.ask(read(0)) == (1000,)


async def test_a_port_has_one_owner(path: Path, eventually: Eventually) -> None:
    async with (
        over_rtu(path) as (bus, _),
        open_bus(RtuAddress(port=str(path), timeout=PATIENCE)) as other,
    ):
        await eventually(lambda: other.statistics.errors["connect"] > 0)
        with pytest.raises(LinkLost, match="in use by another program"):
            await other.ask(read(0))
        assert await bus.ask(read(0)) == (1000,)


def filled(port: int) -> int:
    """How many octets a port took until it was full."""
    taken = 0
    with suppress(BlockingIOError):
        while True:
            taken += os.write(port, bytes(1024))
    return taken


async def test_a_port_that_takes_nothing_is_lost_not_waited_for(path: Path) -> None:
    async with over_rtu(path) as (bus, far):
        far.deafen()
        line = bus._line
        assert line is not None
        port = os.open(path, os.O_WRONLY | os.O_NOCTTY | os.O_NONBLOCK)
        # The kernel makes room once more when it moves the octets on.
        while filled(port):  # noqa: ASYNC110
            await asyncio.sleep(0.2)
        os.close(port)
        with pytest.raises(LinkLost, match=r"adapter (took|cannot be written)"):
            await bus.ask(read(0))
        assert not bus.up.is_set()


async def test_a_slow_adapter_is_told_of_once(path: Path, tmp_path: Path) -> None:
    async with plugged(path) as far:
        device = tmp_path / "class/tty" / far.name / "device"
        device.mkdir(parents=True)
        (device / "latency_timer").write_text("16\n")
        connector = SerialConnector(
            RtuAddress(port=str(path), timeout=PATIENCE),
            ModbusRtu().frame_length,
            BusStatistics(),
            silence=0.0,
            sysfs=tmp_path,
        )
        with capture_logs() as logs:
            for _ in range(2):
                (await connector.open()).close()
    assert [entry["latency_timer_ms"] for entry in logs] == [16]


async def test_a_port_that_takes_its_time_to_open_stops_nobody(path: Path) -> None:
    go, began, ports = threading.Event(), threading.Event(), list[serial.Serial]()

    def slowly(address: SerialAddress) -> serial.Serial:
        began.set()
        go.wait(SOON)
        ports.append(open_port(address))
        return ports[0]

    async with plugged(path):
        connector = SerialConnector(
            RtuAddress(port=str(path), timeout=PATIENCE),
            ModbusRtu().frame_length,
            BusStatistics(),
            silence=0.0,
            open_=slowly,
        )
        opening = asyncio.create_task(connector.open())
        await asyncio.to_thread(began.wait, SOON)
        # Whoever waited for the port in this thread would never come here.
        opening.cancel()
        with pytest.raises(asyncio.CancelledError):
            await opening
        go.set()
        async with asyncio.timeout(SOON):
            while not ports or ports[0].is_open:  # noqa: ASYNC110
                await asyncio.sleep(0.001)


async def test_a_bus_that_comes_and_goes_is_logged_once_each(
    path: Path, eventually: Eventually
) -> None:
    with capture_logs() as logs:
        async with open_bus(RtuAddress(port=str(path), timeout=PATIENCE)) as bus:
            steady(bus)
            await eventually(lambda: bus.statistics.errors["connect"] > 1)
            async with plugged(path) as far:
                await up(bus)
                for _ in range(2):
                    await bus.ask(read(0))
                far.unplug()
                await eventually(lambda: bus.statistics.errors["connect"] > 3)
                far.plug()
                await up(bus)
                await bus.ask(read(0))
    assert [entry["event"] for entry in logs] == [
        "bus is lost",
        "bus answers",
        "bus is lost",
        "bus answers",
    ]
    assert "does not exist" in logs[0]["cause"]
    assert "gone" in logs[2]["cause"]
    assert {entry["bus"] for entry in logs} == {str(path)}
