"""The processes that know no HTTP: bench and control.

Each can be a systemd unit of its own; ``gripperd run`` starts and watches all of them.
"""

import asyncio
import ctypes
import os
import signal
import threading
import time
import uuid
from collections.abc import Callable, Coroutine
from contextlib import AsyncExitStack
from functools import partial
from pathlib import Path
from typing import Any

import structlog
import uvloop

from gripperd.cli.garbage import spare_what_stays
from gripperd.cli.latches import adopt_faults, keep_latched
from gripperd.cli.notify import notify
from gripperd.cli.supervisor import SUPERVISED, stop_requested
from gripperd.cli.tares import adopt_zero, keep_zeros
from gripperd.cli.watchdog import Watchdog, longest_silence
from gripperd.config import BenchBus, GripperSettings, Settings
from gripperd.control.gripper import Gripper
from gripperd.control.loop import Loop
from gripperd.drivers.analog import AnalogRig, AnyBus
from gripperd.drivers.bus import Address, TcpAddress, open_bus
from gripperd.drivers.facts import warnings
from gripperd.errors import Refused
from gripperd.link.buses import BusDesk
from gripperd.link.control import ControlDesk
from gripperd.link.server import serve

REAL_TIME_PRIORITY = 10
"""Above everything that is not real time, below the kernel's own threads."""
ATTACH_WITHIN = 1.0
"""How long readiness waits for the hardware; a daemon without it is ready too. [s]"""
PR_SET_PDEATHSIG = 1
"""prctl(2): signal to get when the parent dies."""

log = structlog.get_logger()


def run_process(main: Coroutine[Any, Any, None]) -> None:
    """Run one process until it is asked to end, or its supervisor dies.

    Raises
    ------
    Refused
        Its supervisor is dead already.
    """
    try:
        _end_with_supervisor()
    except Refused:
        main.close()
        raise

    async def until_stopped() -> None:
        work = asyncio.create_task(main)
        stop = asyncio.create_task(stop_requested())
        await asyncio.wait({work, stop}, return_when=asyncio.FIRST_COMPLETED)
        if work.done():
            work.result()
        work.cancel()
        await asyncio.gather(work, return_exceptions=True)

    uvloop.run(until_stopped())


def _end_with_supervisor() -> None:
    supervisor = os.environ.get(SUPERVISED)
    if not supervisor:
        return
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)
    # Who died before the call above sends no signal.
    if str(os.getppid()) != supervisor:
        message = f"the supervisor, process {supervisor}, is not there any more"
        raise Refused(message, code="orphaned")


def bench_socket(settings: Settings) -> Path:
    """Where the bench answers the service."""
    return settings.runtime_dir / "bench.sock"


def control_socket(settings: Settings) -> Path:
    """Where control answers the service."""
    return settings.runtime_dir / "control.sock"


def simulated(settings: Settings) -> GripperSettings | None:
    """The gripper on the bench, if there is one."""
    for gripper in settings.grippers.values():
        if isinstance(gripper.bus, BenchBus):
            return gripper
    return None


async def control(
    settings: Settings,
    bench_address: tuple[str, int] | None,
    unlogged: Callable[[], int] = lambda: 0,
) -> None:
    """Control every gripper.

    Parameters
    ----------
    settings
        What it is told to do.
    bench_address
        Where the bench is, if not where the settings say.
    unlogged
        Tells how many log lines were dropped so far.
    """
    real_time = go_real_time()
    loops: dict[str, Loop] = {}
    watchdog = Watchdog(settings.grippers, longest_silence())
    async with AsyncExitStack() as open_things:
        buses: dict[Address, AnyBus] = {}
        wired: dict[str, AnyBus] = {}
        for name, gripper in settings.grippers.items():
            address = _address(gripper, settings, bench_address)
            if address not in buses:
                buses[address] = await open_things.enter_async_context(
                    open_bus(address)
                )
            wired[name] = buses[address]
            loops[name] = Loop(
                Gripper(
                    name,
                    gripper.chain,
                    auto_enable=gripper.auto_enable,
                    identify=lambda: uuid.uuid4().hex,
                    monitoring=gripper.monitoring,
                ),
                AnalogRig(buses[address], gripper.output, gripper.input),
                period=1 / gripper.rate,
                advanced=partial(watchdog.advanced, name),
            )
            adopt_zero(settings.state_dir, gripper, loops[name].gripper)
            adopt_faults(settings.state_dir, loops[name].gripper)
        desk = ControlDesk(
            loops,
            BusDesk(wired),
            real_time=real_time,
            started_at=time.time(),
            unlogged=unlogged,
        )
        await open_things.enter_async_context(
            serve(control_socket(settings), desk.respond)
        )
        _warn(settings)
        spare_what_stays()
        async with asyncio.TaskGroup() as tasks:
            for name, loop in loops.items():
                tasks.create_task(loop.run())
                zeros = keep_zeros(settings.state_dir, settings.grippers[name], loop)
                tasks.create_task(zeros)
                tasks.create_task(keep_latched(settings.state_dir, loop))
            await _attached(loops)
            log.info("control runs", grippers=list(loops), real_time=real_time)
            notify(READY=1)


def _warn(settings: Settings) -> None:
    """Say what a person should hear at every start."""
    for said in settings.warnings:
        log.warning(said)
    for name, gripper in settings.grippers.items():
        for said in warnings(gripper.output, gripper.input):
            log.warning(said, gripper=name)


async def _attached(loops: dict[str, Loop]) -> None:
    """Return when every gripper is attached, or has had its time."""
    for _ in range(100):
        if all(loop.gripper.attached for loop in loops.values()):
            return
        await asyncio.sleep(ATTACH_WITHIN / 100)


def _address(
    gripper: GripperSettings, settings: Settings, bench: tuple[str, int] | None
) -> Address:
    if not isinstance(gripper.bus, BenchBus):
        return gripper.bus
    host, port = bench or (settings.bench.host, settings.bench.port)
    return TcpAddress(host=host, port=port)


def go_real_time() -> bool:
    """Ask for real-time priority; tell whether it was granted.

    For every thread: one without it that is interrupted while it has the interpreter's
    lock would stop those that have it.
    """
    priority = os.sched_param(REAL_TIME_PRIORITY)
    try:
        for thread in threading.enumerate():
            if thread.native_id is not None:
                os.sched_setscheduler(thread.native_id, os.SCHED_FIFO, priority)
    except OSError:
        return False
    return True
