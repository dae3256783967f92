"""What a gripper does while its line is cut or busy, for tests and benchmarks."""

import asyncio
import time
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from dataclasses import dataclass, replace
from itertools import count

from gripperd.control.command import Status
from gripperd.control.gripper import Gripper
from gripperd.control.loop import Loop
from gripperd.control.profile import Mode
from gripperd.control.states import Machine
from gripperd.drivers.analog import AnalogRig
from gripperd.drivers.bus import ModbusBus
from gripperd.protocol.modbus import Read, Table

from ..drivers.far_end import Asked, dead  # noqa: TID252
from .far_rig import GRIPPER, SETTINGS, FarRig
from .stage import ordered, real

SOON = 60.0
"""Longest wait for something that must happen; nothing takes this long. [s]"""
PERIOD = 0.02
"""Of control; the three exchanges on a serial line take 12 ms of silence. [s]"""
QUEUED = 50
"""Reads that wait when a stop comes."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Outage:
    """One cut of the line, on the monotonic clock."""

    offline_after: float
    """From the cut until the state says so. [s]"""
    ready_after: float
    """From the return of the line until commands are taken again. [s]"""
    mended: float
    """When the line was back. [s]"""
    heard: tuple[Asked, ...]
    """Every request since the cut."""


@asynccontextmanager
async def controlled(bus: ModbusBus) -> AsyncIterator[Loop]:
    """Control of the shipped gripper on a bus, ready for commands."""
    ids = count(1)
    gripper = Gripper(
        "g0", GRIPPER.chain, auto_enable=True, identify=lambda: f"c{next(ids)}"
    )
    rig = AnalogRig(bus, GRIPPER.output, GRIPPER.input)
    loop = Loop(gripper, rig, period=PERIOD)
    async with running(loop):
        await became(loop, Machine.READY)
        yield loop


@asynccontextmanager
async def running(loop: Loop) -> AsyncIterator[None]:
    """Let a loop control while inside."""
    control = asyncio.create_task(loop.run())
    try:
        yield
    finally:
        control.cancel()
        with suppress(asyncio.CancelledError):
            await control


async def became(loop: Loop, machine: Machine) -> float:
    """When the machine is found to be in a state. [s]."""
    async with asyncio.timeout(SOON):
        while loop.state().machine is not machine:  # noqa: ASYNC110
            await asyncio.sleep(0.001)
    return time.monotonic()


async def begin(loop: Loop, far: FarRig) -> str:
    """Order an apple to be grasped, in a hurry; the command's id."""
    apple = replace(SETTINGS.profiles["apple"], approach=40e-3, ramp=20e-3)
    far.rig.plant.place(real(apple))
    command, _ = loop.submit(ordered(apple, Mode.CURRENT), SOON, None)
    return command.id


async def hold(loop: Loop, far: FarRig) -> None:
    """Hold an apple."""
    done = await loop.wait(await begin(loop, far), SOON)
    assert done.status is Status.SUCCEEDED, done.error


async def interrupt(
    loop: Loop, far: FarRig, seconds: float, meanwhile: int | None = None
) -> Outage:
    """Cut the line for so long; someone may set the output register meanwhile."""
    before, cut = len(far.heard), time.monotonic()
    far.cut()
    offline = await became(loop, Machine.OFFLINE)
    await asyncio.sleep(max(cut + seconds - time.monotonic(), 0.0))
    if meanwhile is not None:
        far.output = meanwhile
    assert loop.state().machine is Machine.OFFLINE
    mended = time.monotonic()
    far.mend()
    ready = await became(loop, Machine.READY)
    return Outage(
        offline_after=offline - cut,
        ready_after=ready - mended,
        mended=mended,
        heard=tuple(far.heard[before:]),
    )


async def stop_behind_reads(
    loop: Loop, bus: ModbusBus, far: FarRig
) -> tuple[float, tuple[Asked, ...]]:
    """Stop a grasp while one request is in flight and others wait in numbers.

    Returns
    -------
    From the end of the request in flight until the write is heard [s], and all that
    was heard since then.
    """
    await begin(loop, far)
    async with asyncio.timeout(SOON):
        while far.rig.plant.velocity < 0.01:  # noqa: ASYNC110
            await asyncio.sleep(0.001)
    far.far.behave = dead
    await far.far.has(len(far.heard) + 1)
    before = len(far.heard)
    reads = [
        asyncio.create_task(bus.ask(Read(1, Table.HOLDING, 1 + n % 7)))
        for n in range(QUEUED)
    ]
    await asyncio.sleep(0)
    stopping = asyncio.create_task(loop.stop())
    await asyncio.sleep(0)
    over = time.monotonic()
    far.mend()
    far.answer(far.far, far.heard[-1])
    await stopping
    await asyncio.gather(*reads)
    heard = tuple(far.heard[before:])
    return heard[0].at - over, heard
