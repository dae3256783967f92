"""An output module that loses its power, or takes its output to the safe value."""

import asyncio
import tempfile
import time
from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager
from dataclasses import replace
from itertools import count
from pathlib import Path
from random import Random
from typing import NamedTuple

import uvloop

from gripperd.bench.rig import Rig
from gripperd.bench.sensors import Channel, Sensor, SensorSettings
from gripperd.bench.wire_faults import WireFault, WireFaultKind
from gripperd.control.command import Status
from gripperd.control.gripper import Gripper
from gripperd.control.loop import Loop
from gripperd.control.profile import Mode
from gripperd.control.states import Machine
from gripperd.drivers.analog import AnalogRig, InputWiring, OutputWiring
from gripperd.protocol.modules import InputModule, OutputModule
from tests.bench.line import DESCRIBED, OnLine, on_line
from tests.control.far_rig import GRIPPER, SETTINGS
from tests.control.outage import PERIOD, SOON, became, running
from tests.control.stage import ordered, real
from tests.faults.row import Row

OUTPUT, INPUT = DESCRIBED["adam_6224"], DESCRIBED["adam_6217"]
"""It has a watchdog that latches, and says so in its status."""
assert GRIPPER.input is not None
SENSORS = {
    name: wiring
    for name, wiring in GRIPPER.input.sensors.items()
    if name in set(Channel)
}
TIMEOUT = 0.2
WITHIN = 0.3
LEFT_ALONE = 1.0
"""How long nothing may be written afterwards. [s]"""
TRIES = 2


class Driven(NamedTuple):
    """A module that holds an apple."""

    line: OnLine
    rig: Rig
    loop: Loop


@asynccontextmanager
async def driven() -> AsyncIterator[Driven]:
    """Control of a gripper on modules with a watchdog, holding."""
    assert isinstance(OUTPUT, OutputModule)
    assert isinstance(INPUT, InputModule)
    rig = Rig(GRIPPER.chain, Random(1), sensors=SensorSettings(**noisy()))
    with tempfile.TemporaryDirectory() as name:
        modules = (OUTPUT.name, INPUT.name)
        folder = Path(name)
        async with on_line("tcp", rig, folder, *modules, patience=TIMEOUT) as line:
            valve = OutputWiring(module=OUTPUT, unit=1, channel=0)
            wired = InputWiring(module=INPUT, unit=2, sensors=SENSORS)
            async with holding(AnalogRig(line.bus, valve, wired), rig) as loop:
                yield Driven(line, rig, loop)


@asynccontextmanager
async def holding(driver: AnalogRig, rig: Rig) -> AsyncIterator[Loop]:
    """Control of the shipped gripper on any modules, holding an apple."""
    ids = count()
    gripper = Gripper(
        "g0", GRIPPER.chain, auto_enable=True, identify=lambda: f"{next(ids)}"
    )
    loop = Loop(gripper, driver, period=PERIOD)
    async with running(loop):
        await became(loop, Machine.READY)
        apple = replace(SETTINGS.profiles["apple"], approach=40e-3, ramp=20e-3)
        rig.plant.place(real(apple))
        given, _ = loop.submit(ordered(apple, Mode.CURRENT), SOON, None)
        done = await loop.wait(given.id, SOON)
        assert done.status is Status.SUCCEEDED, done.error
        yield loop


def noisy() -> dict[str, Sensor]:
    """The sensors of the shipped gripper, with the noise of the shipped bench."""
    return {name: Sensor(wiring.scale, 5e-4) for name, wiring in SENSORS.items()}


async def _noticed(loop: Loop) -> float:
    """When it is seen that the output is not what it was told. [s]"""
    async with asyncio.timeout(SOON):
        while loop.state().machine is Machine.READY:  # noqa: ASYNC110
            await asyncio.sleep(0.001)
    return time.monotonic()


async def befallen(name: str, *kinds: WireFaultKind, tries: int = TRIES) -> Row:
    """Let something befall the output module while an apple is held."""
    took, told, wrong = [], set[str](), set[str]()
    for _ in range(tries):
        async with driven() as (line, rig, loop):
            held = rig.plant.current
            faults = [WireFault(kind=kind, unit=1) for kind in kinds]
            start = time.monotonic()
            line.bench.faults.set(faults)
            took.append(await _noticed(loop) - start)
            await asyncio.sleep(LEFT_ALONE)
            told.add(_told(loop))
            _clear(line)
            await asyncio.sleep(LEFT_ALONE)
            told.add(_told(loop))
            if abs(rig.plant.current - held) < 1e-6:
                wrong.add("driven again")
            if loop.state().machine is not Machine.FAULT:
                wrong.add(f"{loop.state().machine}")
    return Row(
        fault=name,
        noticed=", ".join(sorted(told)),
        took=tuple(took),
        limit=WITHIN,
        wrong=tuple(sorted(wrong)),
    )


def _clear(line: OnLine) -> None:
    """Clear the watchdog, as a person does with the maker's tool."""
    for output in line.bench.modules.outputs:
        output.watchdog.clear()


def _told(loop: Loop) -> str:
    """What the state says in a few words."""
    state = loop.state()
    latched = [fault.cause for fault in loop.gripper.faults.newest(9) if fault.latched]
    if state.machine is Machine.OFFLINE and "watchdog has tripped" in state.link:
        return "offline: watchdog tripped"
    return f"{state.machine}: {', '.join(latched)}"


def rows() -> Iterator[Row]:
    """Each while an apple is held; nothing may be written until a person is there."""
    cycled, tripped = WireFaultKind.POWER_CYCLED, WireFaultKind.WATCHDOG_TRIPPED
    yield uvloop.run(befallen("output module power-cycled", cycled))
    yield uvloop.run(befallen("its watchdog tripped, latched", tripped))
    yield uvloop.run(befallen("power-cycled, watchdog latched", cycled, tripped))
