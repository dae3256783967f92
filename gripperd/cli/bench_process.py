"""The process of the simulated rig."""

import asyncio
import random
from collections.abc import AsyncIterator, Sequence
from contextlib import AsyncExitStack, asynccontextmanager
from dataclasses import replace

import structlog

from gripperd.bench.modules import Fitted, Modules
from gripperd.bench.rig import Rig
from gripperd.bench.sensors import Channel, Sensor, SensorSettings
from gripperd.bench.serial_server import serve_serial
from gripperd.bench.server import BenchServer, serve_bench
from gripperd.bench.wire_faults import WireFaults
from gripperd.cli.bench_line import BenchLine, lying
from gripperd.cli.garbage import spare_what_stays
from gripperd.cli.notify import notify
from gripperd.cli.processes import bench_socket, go_real_time, simulated
from gripperd.config import GripperSettings, Settings
from gripperd.errors import ConfigError, Refused
from gripperd.link.bench import BenchDesk
from gripperd.link.server import serve

log = structlog.get_logger()


async def bench(settings: Settings, line: BenchLine) -> None:
    """Simulate the rig, on the wire."""
    gripper = _gripper(settings, line)
    rng = random.Random(settings.bench.seed)
    rig = Rig(gripper.chain, rng, sensors=_sensors(gripper, settings.bench.noise))
    if line.object is not None:
        rig.plant.place(lying(line.object, settings.profiles))
    fitted = line.fitted or _wired(gripper, settings)
    for each in fitted:
        for said in each.module.doubts:
            log.warning(said)
    # A generator of their own: a fault leaves the noise of the sensors alone.
    faults = WireFaults(random.Random(settings.bench.seed + 1))
    faults.set(line.faults, line.chance)
    # It stands for hardware, which does not wait for a processor.
    go_real_time()
    async with AsyncExitStack() as stack:
        server = await stack.enter_async_context(
            _served(Modules(rig, *fitted), settings, line, faults)
        )
        desk = BenchDesk(server, rig)
        try:
            await stack.enter_async_context(serve(bench_socket(settings), desk.respond))
        except Refused as error:
            if not line.fitted:
                raise
            log.warning("REST does not reach this bench", cause=str(error))
        spare_what_stays()
        log.info("bench listens", **_said(server, line, fitted))
        notify(READY=1, ADDRESS=server.address)
        await asyncio.Event().wait()


@asynccontextmanager
async def _served(
    modules: Modules, settings: Settings, line: BenchLine, faults: WireFaults
) -> AsyncIterator[BenchServer]:
    if line.port is None:
        host, port = line.tcp or (settings.bench.host, settings.bench.port)
        async with serve_bench(modules, host, port, faults=faults) as server:
            yield server
        return
    speaker, port_ = line.port.speaker(modules), line.port
    async with serve_serial(speaker, port_.path, port_.pace, faults=faults) as server:
        yield server


def _gripper(settings: Settings, line: BenchLine) -> GripperSettings:
    """The gripper whose muscle, linkage and sensors the rig has."""
    gripper = simulated(settings)
    if line.fitted:
        return gripper or next(iter(settings.grippers.values()))
    if gripper is None or gripper.input is None:
        message = f"{settings.source}: no gripper with inputs is on the bench"
        raise ConfigError(message)
    return gripper


def _wired(gripper: GripperSettings, settings: Settings) -> Sequence[Fitted]:
    """Modules that the settings say are on the bench."""
    output, inputs = gripper.output, gripper.input
    wired = [Fitted(output.module, output.unit, output.range_name)]
    if inputs is not None:
        wired.append(Fitted(inputs.module, inputs.unit, inputs.range_name))
    return wired


def _said(
    server: BenchServer, line: BenchLine, fitted: Sequence[Fitted]
) -> dict[str, object]:
    """Where it listens, and who is there where that was asked for."""
    said: dict[str, object] = {server.speaker.name: server.address}
    if line.port is not None:
        said["baud"] = line.port.pace.baud
    if line.fitted:
        said["modules"] = [f"{each.module.name} unit {each.unit}" for each in fitted]
    return said


def _sensors(gripper: GripperSettings, noise: float) -> SensorSettings:
    """Transmitters of the bench, matched to how the gripper reads them."""
    settings = SensorSettings()
    if gripper.input is None:
        return settings
    for channel in Channel:
        wiring = gripper.input.sensors.get(channel)
        if wiring is not None:
            sensor = Sensor(wiring.scale, noise)
            settings = replace(settings, **{channel.value: sensor})
    return settings
