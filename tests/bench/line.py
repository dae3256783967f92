"""Benches on real lines, with our bus on the other end."""

from collections.abc import AsyncIterator, Mapping, Sequence
from contextlib import asynccontextmanager
from pathlib import Path
from random import Random
from typing import Any, NamedTuple

from gripperd.bench.modbus_speaker import RtuSpeaker
from gripperd.bench.modules import Fitted, Modules
from gripperd.bench.rig import Rig
from gripperd.bench.serial_server import serve_serial
from gripperd.bench.server import BenchServer, serve_bench
from gripperd.bench.text_speaker import DconSpeaker, ItvSpeaker
from gripperd.bench.wire_faults import WireFaults
from gripperd.config.module_library import ModuleLibrary
from gripperd.drivers.bus import (
    Bus,
    DconAddress,
    ItvAddress,
    RtuAddress,
    TcpAddress,
    open_bus,
)
from gripperd.protocol.modules import InputModule, ModuleDialect, OutputModule

from ..drivers.steady import steady  # noqa: TID252

SOON = 60.0
"""Longest wait for something that must happen; no test takes this long. [s]"""
PATIENCE = 0.1
"""Time-out of a serial line, and so the silence that drains it. [s]"""
PATIENT = 60.0
"""Time-out where a busy machine must not make a test fail. [s]"""

DESCRIBED: Mapping[str, OutputModule | InputModule] = {
    module.name: module for module in ModuleLibrary().all()
}
LINES = {
    "tcp": (ModuleDialect.MODBUS,),
    "rtu": (ModuleDialect.MODBUS,),
    "dcon": (ModuleDialect.DCON, ModuleDialect.ADAM_ASCII),
    "itv": (ModuleDialect.ITV,),
}


class OnLine(NamedTuple):
    """A bench and a bus that leads to it."""

    bench: BenchServer
    bus: Bus[Any, Any]


def fitted(*names: str) -> Sequence[Fitted]:
    """Modules as described, from unit 1 on."""
    return [Fitted(DESCRIBED[name], unit) for unit, name in enumerate(names, 1)]


def spoken(name: str) -> Sequence[str]:
    """Lines on which a module can be asked."""
    known = set(DESCRIBED[name].dialects)
    return [line for line, dialects in LINES.items() if known & set(dialects)]


@asynccontextmanager
async def on_line(
    kind: str, rig: Rig, folder: Path, *names: str, patience: float = PATIENCE
) -> AsyncIterator[OnLine]:
    """Modules on a line of a kind; serial ones take no time."""
    modules, faults = Modules(rig, *fitted(*names)), WireFaults(Random(1))
    if kind == "tcp":
        async with serve_bench(modules, "127.0.0.1", 0, faults=faults) as bench:
            host, _, port = bench.address.rpartition(":")
            address = TcpAddress(host=host, port=int(port), timeout=patience)
            async with open_bus(address) as bus:
                steady(bus)
                await bus.up.wait()
                yield OnLine(bench, bus)
        return
    speak = {"rtu": RtuSpeaker, "dcon": DconSpeaker, "itv": ItvSpeaker}[kind]
    open_at = {"rtu": RtuAddress, "dcon": DconAddress, "itv": ItvAddress}[kind]
    path = folder / kind
    async with (
        serve_serial(speak(modules), path, None, faults=faults) as bench,
        open_bus(open_at(port=str(path), timeout=patience)) as bus,
    ):
        steady(bus)
        await bus.up.wait()
        yield OnLine(bench, bus)
