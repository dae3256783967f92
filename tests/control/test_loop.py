import asyncio
from collections.abc import AsyncIterator, Awaitable, Callable, Mapping
from contextlib import asynccontextmanager, suppress
from dataclasses import replace
from itertools import count

import pytest
from structlog.testing import capture_logs

from gripperd.bench.modules import Modules
from gripperd.bench.rig import Rig
from gripperd.bench.server import BenchServer, serve_bench
from gripperd.config.module_library import ModuleLibrary
from gripperd.control.command import Command, GraspOrder, Status
from gripperd.control.gripper import Gripper
from gripperd.control.journal import Happening
from gripperd.control.loop import Loop
from gripperd.control.profile import Mode, Profile
from gripperd.control.states import Grip, Machine
from gripperd.drivers.analog import AnalogRig, OutputWiring
from gripperd.drivers.bus import ModbusBus, TcpAddress, open_bus
from gripperd.errors import LinkError, NotFound, Refused
from gripperd.model import Chain
from gripperd.protocol.modbus import Read, Table

from ..drivers.peer import Line, Peer, listening  # noqa: TID252
from .stage import ordered, real

Wired = Callable[[ModbusBus], AnalogRig]
Eventually = Callable[[Callable[[], bool]], Awaitable[None]]
SOON = 60.0
"""Longest wait for something that must happen; no test takes this long. [s]"""


@pytest.fixture
def order(profiles: Mapping[str, Profile]) -> GraspOrder:
    """An apple, grasped in a hurry."""
    hasty = replace(profiles["apple"], approach=40e-3, ramp=20e-3)
    return ordered(hasty, Mode.CURRENT)


@asynccontextmanager
async def running(
    bus: ModbusBus, chain: Chain, wired: Wired, period: float = 0.01
) -> AsyncIterator[Loop]:
    ids = count(1)
    gripper = Gripper("g0", chain, auto_enable=True, identify=lambda: f"c{next(ids)}")
    loop = Loop(gripper, wired(bus), period=period)
    task = asyncio.create_task(loop.run())
    try:
        yield loop
    finally:
        task.cancel()
        with suppress(asyncio.CancelledError):
            await task


@pytest.fixture
async def loop(
    bench_address: TcpAddress, chain: Chain, wired: Wired, eventually: Eventually
) -> AsyncIterator[Loop]:
    """Control over loopback in real time, ready for commands."""
    async with open_bus(bench_address) as bus, running(bus, chain, wired) as loop:
        await eventually(lambda: loop.state().machine is Machine.READY)
        yield loop


async def complete(loop: Loop, order: GraspOrder | None) -> Command:
    command, _ = loop.submit(order, SOON, None)
    return await loop.wait(command.id, SOON)


async def test_an_apple_is_grasped_and_released_over_the_wire(
    loop: Loop, rig: Rig, order: GraspOrder, eventually: Eventually
) -> None:
    rig.plant.place(real(order.profile))
    grasp = await complete(loop, order)
    assert grasp.status is Status.SUCCEEDED, grasp.error
    assert grasp.result is not None
    assert grasp.result.force == pytest.approx(rig.plant.grip, rel=0.02)
    assert grasp.result.force == pytest.approx(grasp.result.predicted_force, rel=0.05)
    assert loop.state().grip is Grip.HOLDING
    release = await complete(loop, None)
    assert release.status is Status.SUCCEEDED
    assert loop.state().grip is Grip.RELEASED
    await eventually(lambda: rig.plant.opening > 0.0849)


async def test_a_stop_is_on_the_wire_when_it_returns(
    loop: Loop, rig: Rig, order: GraspOrder, eventually: Eventually
) -> None:
    command, _ = loop.submit(order, SOON, None)
    await eventually(lambda: rig.plant.velocity > 0.01)
    stopped = await loop.stop()
    assert stopped.machine is Machine.STOPPING
    assert stopped.current == pytest.approx(rig.plant.current, abs=0.6e-6)
    assert loop.gripper.ledger.get(command.id).status is Status.CANCELLED
    await eventually(lambda: loop.state().machine is Machine.READY)
    assert rig.plant.current == pytest.approx(stopped.current, abs=0.6e-6)


async def test_a_cancel_is_on_the_wire_when_it_returns(
    loop: Loop, rig: Rig, order: GraspOrder, eventually: Eventually
) -> None:
    command, _ = loop.submit(order, SOON, None)
    await eventually(lambda: rig.plant.velocity > 0.01)
    cancelled = await loop.cancel(command.id)
    assert cancelled.status is Status.CANCELLED
    assert loop.state().current == pytest.approx(rig.plant.current, abs=0.6e-6)


async def test_whoever_reads_the_log_hears_of_faults(
    loop: Loop, eventually: Eventually
) -> None:
    with capture_logs() as logs:
        loop.gripper.ledger.journal.note(Happening.FAULT, "burst: 0 kPa", 0.0)
        loop.gripper.ledger.journal.note(Happening.FAULT, "burst cleared", 1.0)
        await eventually(lambda: any(each["event"] == "fault" for each in logs))
    told = [each["what"] for each in logs if each["event"] == "fault"]
    assert told == ["burst: 0 kPa", "burst cleared"]


async def test_who_waits_gets_the_command_as_it_stands(
    loop: Loop, order: GraspOrder, eventually: Eventually
) -> None:
    command, _ = loop.submit(order, SOON, None)
    assert (await loop.wait(command.id, 0.0)).status is Status.QUEUED
    await eventually(
        lambda: loop.gripper.ledger.get(command.id).status is Status.RUNNING
    )
    assert (await loop.wait(command.id, 0.0)).status is Status.RUNNING
    await loop.stop()
    assert (await loop.wait(command.id, SOON)).status is Status.CANCELLED


async def test_there_is_no_waiting_for_what_is_not_there(loop: Loop) -> None:
    with pytest.raises(NotFound):
        await loop.wait("c99", SOON)


async def test_measurements_go_on_coming(loop: Loop, eventually: Eventually) -> None:
    seen = set()

    def fresh() -> bool:
        measured = loop.state().measured
        assert measured is not None
        seen.add(measured.time)
        return len(seen) == 5

    await eventually(fresh)


async def test_a_lost_bench_ends_the_command_and_is_adopted_when_it_is_back(
    modules: Modules,
    chain: Chain,
    wired: Wired,
    order: GraspOrder,
    eventually: Eventually,
) -> None:
    plant = modules.rig.plant
    async with serve_bench(modules, "127.0.0.1", 0) as bench:
        port = int(bench.address.rpartition(":")[2])
        now = bench._now
        address = TcpAddress(host="127.0.0.1", port=port, timeout=SOON)
        bus_context = open_bus(address)
        bus = await bus_context.__aenter__()
        loop_context = running(bus, chain, wired)
        loop = await loop_context.__aenter__()
        await eventually(lambda: loop.state().machine is Machine.READY)
        command, _ = loop.submit(order, SOON, None)
        await eventually(lambda: plant.current > 0.005)
    try:
        lost = await loop.wait(command.id, SOON)
        assert lost.status is Status.FAILED
        assert lost.error is not None
        assert lost.error.code == "link-lost"
        assert loop.state().machine is Machine.OFFLINE
        assert loop.state().current is None
        left = plant.current
        start = now()
        async with serve_bench(
            modules, "127.0.0.1", port, lambda: now() - start + plant.time
        ):
            await eventually(lambda: loop.state().machine is Machine.READY)
            assert loop.state().adopted
            assert loop.state().current == pytest.approx(left)
            assert plant.current == left
    finally:
        await loop_context.__aexit__(None, None, None)
        await bus_context.__aexit__(None, None, None)


@asynccontextmanager
async def relayed(modules: Modules, delay: float = 0.0) -> AsyncIterator[Peer]:
    """The bench behind a gateway that takes its time for every reply."""
    loop = asyncio.get_running_loop()
    bench = BenchServer(modules, loop.time)

    def behave(line: Line, frame: bytes) -> None:
        loop.call_later(delay, line.send, bench.answer(frame))

    async with listening(behave) as peer:
        yield peer


async def test_a_stop_that_does_not_arrive_is_an_error(
    modules: Modules,
    chain: Chain,
    wired: Wired,
    order: GraspOrder,
    eventually: Eventually,
) -> None:
    async with relayed(modules) as peer:
        address = TcpAddress(host="127.0.0.1", port=peer.port, timeout=SOON)
        async with open_bus(address) as bus, running(bus, chain, wired) as loop:
            await eventually(lambda: loop.state().machine is Machine.READY)
            loop.submit(order, SOON, None)
            await eventually(lambda: modules.rig.plant.velocity > 0.01)
            peer.behave = lambda line, _: line.hang_up()
            with pytest.raises((LinkError, Refused)):
                await loop.stop()
            assert loop.state().machine is Machine.OFFLINE


async def test_the_ramp_keeps_time_on_a_slow_bus(
    modules: Modules,
    chain: Chain,
    wired: Wired,
    order: GraspOrder,
    eventually: Eventually,
) -> None:
    async with relayed(modules, 0.010) as peer:
        address = TcpAddress(host="127.0.0.1", port=peer.port, timeout=SOON)
        async with open_bus(address) as bus, running(bus, chain, wired, 0.02) as loop:
            await eventually(lambda: loop.state().machine is Machine.READY)
            command = await complete(loop, order)
    assert command.result is not None
    assert command.started_at is not None
    assert command.completed_at is not None
    real_time = command.completed_at - command.started_at
    assert command.result.duration == pytest.approx(real_time, rel=0.25)


async def test_an_older_write_never_follows_a_stop(
    modules: Modules,
    chain: Chain,
    wired: Wired,
    order: GraspOrder,
    eventually: Eventually,
) -> None:
    plant = modules.rig.plant
    held: list[bytes] = []
    async with relayed(modules) as peer:
        address = TcpAddress(host="127.0.0.1", port=peer.port, timeout=SOON)
        async with open_bus(address) as bus, running(bus, chain, wired) as loop:
            await eventually(lambda: loop.state().machine is Machine.READY)
            loop.submit(order, SOON, None)
            await eventually(lambda: plant.velocity > 0.01)
            answer, peer.behave = peer.behave, lambda _, frame: held.append(frame)
            line = peer.lines[0]
            await eventually(lambda: bool(held))
            while held[-1][7] != Table.INPUT:
                answer(line, held.pop())
                await eventually(lambda: bool(held))
            # Another gripper on the same bus asks before this one writes.
            other = asyncio.create_task(bus.ask(Read(1, Table.HOLDING, 7)))
            await asyncio.sleep(0)
            answer(line, held.pop())
            await eventually(lambda: bool(held and bus._turns._waiting))
            stopping = asyncio.create_task(loop.stop())
            await asyncio.sleep(0)
            peer.behave = answer
            answer(line, held.pop())
            await other
            stopped = await stopping
            await eventually(lambda: loop.state().machine is Machine.READY)
            assert plant.current == pytest.approx(stopped.current, abs=0.6e-6)


async def test_a_current_the_module_cannot_give_ends_the_command_not_the_loop(
    modules: Modules,
    bench_address: TcpAddress,
    chain: Chain,
    wired: Wired,
    order: GraspOrder,
    eventually: Eventually,
) -> None:
    async with open_bus(bench_address) as bus:
        module = ModuleLibrary().output("waveshare_ao_8ch")
        weak = replace(module.range(), current_high=0.005, count_high=5000.0)
        output = OutputWiring(
            module=replace(module, ranges={"weak": weak}), unit=1, channel=0
        )
        rig = AnalogRig(bus, output, wired(bus)._input_wiring)
        ids = iter(range(9))
        gripper = Gripper(
            "g0", chain, auto_enable=True, identify=lambda: f"{next(ids)}"
        )
        loop = Loop(gripper, rig, period=0.01)
        task = asyncio.create_task(loop.run())
        await eventually(lambda: loop.state().machine is Machine.READY)
        command, _ = loop.submit(order, SOON, None)
        ended = await loop.wait(command.id, SOON)
        assert ended.error is not None
        assert "is outside 0 to 5 mA" in ended.error.message
        await eventually(lambda: loop.state().machine is Machine.READY)
        task.cancel()
