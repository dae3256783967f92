"""Buses: what is spoken at an address, and who owns it."""

import asyncio
from collections.abc import AsyncIterator
from contextlib import AbstractAsyncContextManager, asynccontextmanager, suppress
from typing import TypeAlias, TypeVar, overload

from gripperd.drivers.address import (
    Address,
    DconAddress,
    ItvAddress,
    RtuAddress,
    SerialAddress,
    TcpAddress,
)
from gripperd.drivers.exchange import Exchange, Trace
from gripperd.drivers.owner import Bus
from gripperd.drivers.serial_connector import SerialConnector
from gripperd.drivers.statistics import BusStatistics
from gripperd.drivers.tcp import TcpConnector
from gripperd.protocol import dcon, itv, mbap, modbus, rtu
from gripperd.protocol.dialect import Dialect

__all__ = [
    "Address",
    "Bus",
    "DconAddress",
    "DconBus",
    "Exchange",
    "ItvAddress",
    "ItvBus",
    "ModbusBus",
    "RtuAddress",
    "SerialAddress",
    "TcpAddress",
    "Trace",
    "open_bus",
]

Q = TypeVar("Q")
R = TypeVar("R")

ModbusBus: TypeAlias = Bus[modbus.Request, tuple[int, ...]]
DconBus: TypeAlias = Bus[dcon.Ask, str]
ItvBus: TypeAlias = Bus[itv.Request, int]


@overload
def open_bus(
    address: TcpAddress | RtuAddress, trace: Trace | None = None
) -> AbstractAsyncContextManager[ModbusBus]: ...
@overload
def open_bus(
    address: DconAddress, trace: Trace | None = None
) -> AbstractAsyncContextManager[DconBus]: ...
@overload
def open_bus(
    address: ItvAddress, trace: Trace | None = None
) -> AbstractAsyncContextManager[ItvBus]: ...


def open_bus(
    address: Address, trace: Trace | None = None
) -> (
    AbstractAsyncContextManager[ModbusBus]
    | AbstractAsyncContextManager[DconBus]
    | AbstractAsyncContextManager[ItvBus]
):
    """Own a bus while inside; it opens by itself, now or when the peer is there."""
    match address:
        case TcpAddress():
            tcp, statistics = mbap.ModbusTcp(), BusStatistics()
            connector = TcpConnector(address, tcp.frame_length, statistics)
            return _owned(Bus(address, tcp, connector, statistics, trace))
        case RtuAddress():
            line = rtu.ModbusRtu(local_echo=address.local_echo)
            return _owned(_serial(address, line, rtu.silence(address.baud), trace))
        case DconAddress():
            ascii_line = dcon.Dcon(
                checksum=address.checksum, local_echo=address.local_echo
            )
            return _owned(_serial(address, ascii_line, 0.0, trace))
        case ItvAddress():
            return _owned(_serial(address, itv.Itv(), 0.0, trace))


def _serial(
    address: RtuAddress | DconAddress | ItvAddress,
    dialect: Dialect[Q, R],
    silence: float,
    trace: Trace | None,
) -> Bus[Q, R]:
    statistics = BusStatistics()
    connector = SerialConnector(address, dialect.frame_length, statistics, silence)
    return Bus(address, dialect, connector, statistics, trace)


@asynccontextmanager
async def _owned(bus: Bus[Q, R]) -> AsyncIterator[Bus[Q, R]]:
    supervisor = asyncio.create_task(bus.supervise(), name=f"bus {bus.address}")
    try:
        yield bus
    finally:
        supervisor.cancel()
        with suppress(asyncio.CancelledError):
            await supervisor
        bus.close()
