import asyncio
from collections.abc import AsyncIterator, Callable, Mapping
from contextlib import suppress
from dataclasses import replace
from itertools import count
from pathlib import Path

import msgspec
import pytest

from gripperd.bench.object import BenchObject
from gripperd.bench.rig import Rig
from gripperd.control.command import Command, GraspOrder, Status
from gripperd.control.gripper import Gripper
from gripperd.control.ledger import Key
from gripperd.control.loop import Loop
from gripperd.control.profile import Mode, Profile
from gripperd.control.snapshot import GripperState
from gripperd.control.states import Grip, Machine
from gripperd.drivers.analog import AnalogRig
from gripperd.drivers.bus import ModbusBus, TcpAddress, open_bus
from gripperd.errors import BadReply, InputError, NotFound, Refused
from gripperd.link.client import Client
from gripperd.link.control import (
    Cancel,
    ControlDesk,
    Disable,
    Enable,
    ListCommands,
    Overview,
    ReadCommand,
    ReadOverview,
    ReadState,
    Stop,
    Submit,
    Submitted,
    UseModel,
)
from gripperd.link.model import model_message
from gripperd.link.server import serve
from gripperd.model import Chain

APPLE = BenchObject(
    diameter=0.065, stiffness=40e3, mass=0.180, friction=0.5, damage_force=90.0
)
SOON = 60.0
"""Longest wait for something that must happen; no test takes this long. [s]"""


@pytest.fixture
def order(profiles: Mapping[str, Profile]) -> GraspOrder:
    """An apple, grasped in a hurry."""
    hasty = replace(profiles["apple"], approach=40e-3, ramp=20e-3)
    return GraspOrder(profile=hasty, mode=Mode.CURRENT, target=0.0107, model="v1")


@pytest.fixture
async def client(
    bench_address: TcpAddress,
    chain: Chain,
    wired: Callable[[ModbusBus], AnalogRig],
    socket_path: Path,
) -> AsyncIterator[Client]:
    """What the service sees of a gripper on the simulated rig."""
    ids = count(1)
    gripper = Gripper("g0", chain, auto_enable=False, identify=lambda: f"c{next(ids)}")
    async with open_bus(bench_address) as bus:
        loop = Loop(gripper, wired(bus), period=0.01)
        running = asyncio.create_task(loop.run())
        desk = ControlDesk({"g0": loop}, real_time=False, started_at=1e9)
        async with serve(socket_path, desk.respond):
            client = Client(socket_path, "the control process")
            await became(client, Machine.DISABLED)
            yield client
            await client.close()
        running.cancel()
        with suppress(asyncio.CancelledError):
            await running


async def state(client: Client) -> GripperState:
    return await client.ask(ReadState("g0"), GripperState)


async def became(client: Client, machine: Machine) -> None:
    async with asyncio.timeout(SOON):
        while (await state(client)).machine is not machine:  # noqa: ASYNC110
            await asyncio.sleep(0.005)


async def over(client: Client, command: Command) -> Command:
    return await client.ask(ReadCommand("g0", command.id, SOON), Command, 2 * SOON)


async def test_a_whole_grasp_by_messages(
    client: Client, rig: Rig, order: GraspOrder
) -> None:
    rig.plant.place(APPLE)
    enabled = await client.ask(Enable("g0"), GripperState)
    assert enabled.machine is Machine.READY
    submitted = await client.ask(Submit("g0", order, SOON), Submitted)
    assert not submitted.replayed
    assert submitted.command.order == order
    ended = await over(client, submitted.command)
    assert ended.status is Status.SUCCEEDED, ended.error
    assert ended.result is not None
    assert ended.result.force == pytest.approx(rig.plant.grip, rel=0.02)
    holding = await state(client)
    assert (holding.grip, holding.holding) == (Grip.HOLDING, "apple")
    assert holding.measured is not None
    assert holding.measured.grip.value == pytest.approx(rig.plant.grip, rel=0.02)
    with pytest.raises(Refused, match="apple is being held") as refused:
        await client.ask(Submit("g0", order, SOON), Submitted)
    assert (refused.value.code, refused.value.hints) == (
        "object-held",
        ("release first",),
    )
    release = await client.ask(Submit("g0", None, SOON), Submitted)
    assert (await over(client, release.command)).status is Status.SUCCEEDED
    commands = await client.ask(ListCommands("g0", 10), list[Command])
    assert [command.id for command in commands] == ["c2", "c1"]


async def test_a_stop_goes_through_while_another_waits(
    client: Client, order: GraspOrder
) -> None:
    await client.ask(Enable("g0"), GripperState)
    submitted = await client.ask(Submit("g0", order, SOON), Submitted)
    waiting = asyncio.create_task(over(client, submitted.command))
    stopped = await client.ask(Stop("g0"), GripperState)
    assert stopped.machine is Machine.STOPPING
    cancelled = await waiting
    assert cancelled.status is Status.CANCELLED
    assert cancelled.error is not None
    assert cancelled.error.code == "stopped"


async def test_cancel_and_disable(client: Client, order: GraspOrder) -> None:
    await client.ask(Enable("g0"), GripperState)
    submitted = await client.ask(Submit("g0", order, SOON), Submitted)
    cancelled = await client.ask(Cancel("g0", submitted.command.id), Command)
    assert cancelled.status is Status.CANCELLED
    await became(client, Machine.READY)
    disabled = await client.ask(Disable("g0"), GripperState)
    assert disabled.machine is Machine.DISABLED
    with pytest.raises(Refused, match="while the gripper is disabled"):
        await client.ask(Submit("g0", order, SOON), Submitted)


async def test_keys_travel(client: Client, order: GraspOrder) -> None:
    await client.ask(Enable("g0"), GripperState)
    request = Submit("g0", order, SOON, Key("k", "apple"))
    first = await client.ask(request, Submitted)
    again = await client.ask(request, Submitted)
    assert (again.replayed, again.command.id) == (True, first.command.id)
    with pytest.raises(InputError, match="another request") as wrong:
        await client.ask(Submit("g0", None, SOON, Key("k", "release")), Submitted)
    assert wrong.value.key == "Idempotency-Key"


async def test_the_overview_names_the_grippers(client: Client) -> None:
    overview = await client.ask(ReadOverview(), Overview)
    assert overview.grippers == ("g0",)
    assert (overview.real_time, overview.started_at) == (False, 1e9)


async def test_what_is_not_there_is_not_found(client: Client) -> None:
    with pytest.raises(NotFound, match="no gripper 'g7'; there is g0") as missing:
        await client.ask(ReadState("g7"), GripperState)
    assert missing.value.key == "gripper"
    with pytest.raises(NotFound, match="no command 'c9'"):
        await client.ask(ReadCommand("g0", "c9"), Command)


async def test_a_request_nobody_knows_is_told(client: Client) -> None:
    class Explode(msgspec.Struct, frozen=True, tag=True):
        gripper: str

    with pytest.raises(BadReply, match="Explode"):
        await client.ask(Explode("g0"), GripperState)


async def test_another_model_is_taken_up_by_a_message(
    client: Client, chain: Chain, rig: Rig
) -> None:
    before = rig.plant.current
    request = UseModel(("g0",), model_message(replace(chain, name="reference-1")))
    (taken,) = await client.ask(request, list[GripperState])
    assert taken.model == "reference-1"
    assert (await state(client)).model == "reference-1"
    assert rig.plant.current == before


async def test_no_other_model_while_a_command_runs(
    client: Client, chain: Chain, order: GraspOrder
) -> None:
    await client.ask(Enable("g0"), GripperState)
    await client.ask(Submit("g0", order, SOON), Submitted)
    request = UseModel(("g0",), model_message(replace(chain, name="reference-1")))
    with pytest.raises(Refused, match="until it is at rest") as refused:
        await client.ask(request, list[GripperState])
    assert refused.value.code == "wrong-state"
    assert (await state(client)).model == "reference"


async def test_grippers_that_are_not_there_take_up_nothing(
    client: Client, chain: Chain
) -> None:
    request = UseModel(("g0", "g7"), model_message(replace(chain, name="reference-1")))
    with pytest.raises(NotFound, match="no gripper 'g7'"):
        await client.ask(request, list[GripperState])
    assert (await state(client)).model == "reference"
