"""Input modules that say what cannot be, over real lines, while an apple is held."""

import asyncio
import math
import tempfile
import time
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import AbstractAsyncContextManager, asynccontextmanager
from dataclasses import replace
from pathlib import Path
from random import Random
from typing import NamedTuple

import uvloop

from gripperd.bench.faults import BenchFaults
from gripperd.bench.modules import Fitted, Modules
from gripperd.bench.rig import Rig
from gripperd.bench.sensors import Channel, SensorSettings
from gripperd.bench.serial_server import serve_serial
from gripperd.bench.server import serve_bench
from gripperd.bench.text_speaker import DconSpeaker
from gripperd.control.loop import Loop
from gripperd.control.monitors.policy import DETECTION, Cause
from gripperd.control.states import Grip, Machine
from gripperd.drivers.analog import AnalogRig, InputWiring, OutputWiring
from gripperd.drivers.bus import DconAddress, TcpAddress, open_bus
from gripperd.protocol.encoding import Encoding, Range, Registers, ValueType
from gripperd.protocol.modbus import Table
from gripperd.protocol.modules import (
    InputModule,
    ModuleDialect,
    OutputModule,
    RegisterMap,
)
from gripperd.signals import Measurement, Quality, Reading
from tests.bench.line import DESCRIBED
from tests.control.far_rig import GRIPPER
from tests.faults.module import SENSORS, TIMEOUT, holding, noisy
from tests.faults.row import Row, counted

TRIES = 2
PATIENCE = 60.0
"""Longest wait for anything. [s]"""
SAID = 2.0
"""How long a module goes on saying it. [s]"""
PLACE = list(Channel).index(Channel.GRIP)
FIRST, WIDTH = 1, 7
"""Where the currents begin in a line of text, and how long each is."""
FLOATS = RegisterMap(
    values=Registers(Table.INPUT, 0, stride=2), encoding=Encoding(type=ValueType.F32)
)
MILLIAMPERES = Range(
    name="0-20mA", current_low=0.0, current_high=0.02, count_low=0.0, count_high=20.0
)

NUMBERS = (math.nan, math.inf, -math.inf, 3e35, -0.004, 0.0216)
"""What float registers can hold besides a current that a loop can carry. [A]"""
TEXTS = ("+nan   ", "+  inf ", "+9999.9", "+99.999", "-00.000", "+1e4000", "+10,700")
"""What can stand where seven characters should be a current, as after an over-range."""

ONE = frozenset({Channel.GRIP})
WIRES = {
    "force wire shorted, any input module": BenchFaults(shorted=ONE),
    "force wire cut, any input module": BenchFaults(broken=ONE),
}
WARNED = "not told, and warned of at the start"


class Odd(NamedTuple):
    """Something that holds an apple, and can say odd things of its force."""

    rig: Rig
    loop: Loop
    say: Callable[[object], None]
    """None: what is true again."""


class _Misread(Rig):
    """A rig whose force sensor is read as what it cannot be."""

    instead: float | None = None

    def read_inputs(self) -> tuple[float, float, float]:
        pressure, opening, grip = super().read_inputs()
        return pressure, opening, grip if self.instead is None else self.instead


class _Misspoken(DconSpeaker):
    """A line on which the force is written as what it cannot be."""

    instead: str | None = None

    def answer(self, frame: bytes) -> bytes:
        line = super().answer(frame)
        if self.instead is None or not line.startswith(b">+"):
            return line
        start = FIRST + WIDTH * PLACE
        return line[:start] + self.instead.encode() + line[start + WIDTH :]


@asynccontextmanager
async def in_registers() -> AsyncIterator[Odd]:
    """Float registers on Modbus TCP, as a description of one's own may have them."""
    valve = _output("waveshare_ao_8ch")
    like = DESCRIBED["waveshare_ai_8ch"]
    assert isinstance(like, InputModule)
    ranges = {MILLIAMPERES.name: MILLIAMPERES}
    floats = replace(like, name="float_inputs", modbus=FLOATS, ranges=ranges)
    rig = _Misread(GRIPPER.chain, Random(1), sensors=SensorSettings(**noisy()))
    modules = Modules(rig, Fitted(valve, 1), Fitted(floats, 2))

    def say(instead: object) -> None:
        rig.instead = None if instead is None else float(str(instead))

    async with serve_bench(modules, "127.0.0.1", 0) as bench:
        host, _, port = bench.address.rpartition(":")
        at = TcpAddress(host=host, port=int(port), timeout=TIMEOUT)
        async with open_bus(at) as bus:
            output = OutputWiring(module=valve, unit=1, channel=0)
            sensed = InputWiring(module=floats, unit=2, sensors=SENSORS)
            async with holding(AnalogRig(bus, output, sensed), rig) as loop:
                yield Odd(rig, loop, say)


@asynccontextmanager
async def in_text() -> AsyncIterator[Odd]:
    """Lines of text over a pty: DCON to the valve, ADAM ASCII from the sensors."""
    valve, inputs = _output("icpdas_i_7024"), DESCRIBED["adam_4017_plus"]
    assert isinstance(inputs, InputModule)
    rig = Rig(GRIPPER.chain, Random(1), sensors=SensorSettings(**noisy()))
    speaker = _Misspoken(Modules(rig, Fitted(valve, 1), Fitted(inputs, 2)))

    def say(instead: object) -> None:
        speaker.instead = None if instead is None else str(instead)

    with tempfile.TemporaryDirectory() as name:
        path = Path(name) / "line"
        at = DconAddress(port=str(path), timeout=TIMEOUT)
        async with serve_serial(speaker, path, None), open_bus(at) as bus:
            output = OutputWiring(
                module=valve, unit=1, channel=0, dialect=ModuleDialect.DCON
            )
            sensed = InputWiring(
                module=inputs,
                unit=2,
                dialect=ModuleDialect.ADAM_ASCII,
                sensors=SENSORS,
            )
            async with holding(AnalogRig(bus, output, sensed), rig) as loop:
                yield Odd(rig, loop, say)


def _output(name: str) -> OutputModule:
    module = DESCRIBED[name]
    assert isinstance(module, OutputModule)
    return module


Line = Callable[[], AbstractAsyncContextManager[Odd]]


async def said(line: Line, instead: object, tries: int = TRIES) -> Row:
    """Let a module say something impossible of the force, and the truth again."""
    took, wrong, causes = [], set[str](), set[str]()
    async with line() as odd:
        held = odd.rig.plant.current
        for _ in range(tries):
            start = time.monotonic()
            odd.say(instead)
            took.append(await _since(start, lambda: _told(odd.loop)))
            await asyncio.sleep(SAID)
            shown = _force(odd.loop)
            causes.add(shown.cause)
            if shown.quality is not Quality.SUBSTITUTED or shown.value is None:
                wrong.add(f"{shown.quality}")
            state = odd.loop.state()
            if (state.machine, state.grip) != (Machine.READY, Grip.HOLDING):
                wrong.add(f"{state.machine}, {state.grip}")
            odd.say(None)
            await _since(start, lambda: _force(odd.loop).quality is Quality.GOOD)
            await _since(start, lambda: not _told(odd.loop))
        if odd.rig.plant.current != held:
            wrong.add("another current")
    by = "text, pty" if line is in_text else "floats, tcp"
    return Row(
        fault=f"force is {instead!r} ({by})",
        noticed=f"{Cause.SENSOR_FAILED}: {', '.join(sorted(causes))}",
        took=tuple(took),
        limit=DETECTION[Cause.SENSOR_FAILED],
        wrong=tuple(sorted(wrong)),
    )


def _force(loop: Loop) -> Reading:
    measured = loop.state().measured
    return Reading.bad("not measured yet") if measured is None else measured.grip


def _told(loop: Loop) -> bool:
    """Whether a fault names the force sensor."""
    return any(
        (fault.cause, fault.subject) == (Cause.SENSOR_FAILED, "grip")
        for fault in loop.state().faults
    )


async def _since(start: float, happened: Callable[[], bool]) -> float:
    """Time from then until something has happened. [s]."""
    async with asyncio.timeout(PATIENCE):
        while not happened():  # noqa: ASYNC110
            await asyncio.sleep(0.001)
    return time.monotonic() - start


async def wired(name: str, faults: BenchFaults) -> Row:
    """Break the wire of the force sensor on every input module, in every range."""
    valve, found = _output("waveshare_ao_8ch"), []
    output = OutputWiring(module=valve, unit=1, channel=0)
    for module in DESCRIBED.values():
        if not isinstance(module, InputModule) or module.modbus is None:
            continue
        for chosen in module.ranges:
            sensed = InputWiring(
                module=module, unit=2, sensors=SENSORS, range_name=chosen
            )
            driver, measured = await _read(output, sensed, faults)
            if measured.grip.quality is Quality.BAD:
                found.append("told")
            elif faults.broken and any("a cut wire" in w for w in driver.warnings):
                found.append(WARNED)
            else:
                found.append(f"{module.name} {chosen} believed")
    return counted(name, found, {"told", WARNED})


async def _read(
    output: OutputWiring, sensed: InputWiring, faults: BenchFaults
) -> tuple[AnalogRig, Measurement]:
    """What a driver reads of a bench with a fault."""
    rig = Rig(GRIPPER.chain, Random(1), sensors=SensorSettings(**noisy()))
    rig.plant.faults = faults
    inputs = Fitted(sensed.module, sensed.unit, sensed.range_name)
    modules = Modules(rig, Fitted(output.module, output.unit), inputs)
    async with serve_bench(modules, "127.0.0.1", 0) as bench:
        host, _, port = bench.address.rpartition(":")
        async with open_bus(TcpAddress(host=host, port=int(port))) as bus:
            await bus.up.wait()
            driver = AnalogRig(bus, output, sensed)
            return driver, await driver.read(0.0)


def rows() -> Iterator[Row]:
    """Every oddity on the lines that can carry it."""
    for name, faults in WIRES.items():
        yield uvloop.run(wired(name, faults))
    for number in NUMBERS:
        yield uvloop.run(said(in_registers, number))
    for text in TEXTS:
        yield uvloop.run(said(in_text, text))
