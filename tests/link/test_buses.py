"""The desk of the buses, through the real socket and a real bus."""

import asyncio
from pathlib import Path

import pytest

from gripperd.drivers.traffic import Heard
from gripperd.errors import NotFound
from gripperd.link.buses import BusDesk, BusFigures, ReadBuses, ReadTraffic
from gripperd.link.client import Client
from gripperd.link.control import ControlDesk
from gripperd.link.server import serve
from gripperd.protocol.modbus import Read, Table
from tests.drivers.device import Device, holding, on_the_wire

SOON = 60.0
READ = Read(1, Table.HOLDING, 0)


async def test_figures_and_traffic_travel(socket_path: Path) -> None:
    async with on_the_wire(Device(holding(0, 10_700))) as bus:
        desk = ControlDesk(
            {}, BusDesk({"left": bus, "right": bus}), real_time=False, started_at=0.0
        )
        async with serve(socket_path, desk.respond):
            client = Client(socket_path, "the control process")
            await bus.ask(READ)
            assert await client.ask(ReadTraffic("left"), list[Heard]) == []
            await bus.ask(READ)
            (heard,) = await client.ask(ReadTraffic("right"), list[Heard])
            assert heard.exchange.request[6:] == bytes.fromhex("01 03 0000 0001")
            assert heard.exchange.reply[6:] == bytes.fromhex("01 03 02 29CC")
            assert heard.exchange.error is None
            (figures,) = await client.ask(ReadBuses(), list[BusFigures])
            with pytest.raises(NotFound, match="there is left, right"):
                await client.ask(ReadTraffic("middle"), list[Heard])
            await client.close()
    assert (figures.grippers, figures.up) == (("left", "right"), True)
    assert (figures.requests, figures.connections) == (2, 1)
    assert sum(figures.latency_counts) == 2
    assert len(figures.latency_counts) == len(figures.latency_bounds) + 1
    assert figures.errors == {}


async def test_each_bus_has_its_own_grippers_and_figures(socket_path: Path) -> None:
    async with (
        on_the_wire(Device(holding(0, 1))) as left,
        on_the_wire(Device(holding(0, 2))) as right,
    ):
        buses = BusDesk({"l": left, "r": right})
        desk = ControlDesk({}, buses, real_time=False, started_at=0.0)
        async with serve(socket_path, desk.respond):
            client = Client(socket_path, "the control process")
            await right.ask(READ)
            figures = await client.ask(ReadBuses(), list[BusFigures])
            await client.close()
    assert [(each.grippers, each.requests) for each in figures] == [
        (("l",), 0),
        (("r",), 1),
    ]


async def test_errors_are_counted_by_kind(socket_path: Path) -> None:
    async with on_the_wire(Device({})) as bus:
        desk = ControlDesk({}, BusDesk({"g0": bus}), real_time=False, started_at=0.0)
        async with serve(socket_path, desk.respond), asyncio.timeout(SOON):
            client = Client(socket_path, "the control process")
            with pytest.raises(OSError, match="illegal address"):
                await bus.ask(READ)
            (figures,) = await client.ask(ReadBuses(), list[BusFigures])
            await client.close()
    assert figures.errors == {"DeviceRefused": 1}
