"""Faults of the line between control and the modules, in real time."""

import asyncio
import time
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import AsyncExitStack, asynccontextmanager
from itertools import count
from random import Random

import uvloop

from gripperd.bench.modules import Modules
from gripperd.bench.rig import Rig
from gripperd.bench.server import BenchServer
from gripperd.config import GripperSettings, load_settings, shipped
from gripperd.control.gripper import Gripper
from gripperd.control.loop import Loop
from gripperd.control.states import Machine
from gripperd.drivers.analog import AnalogRig
from gripperd.drivers.bus import TcpAddress, open_bus
from tests.control.outage import running
from tests.drivers.peer import Behaviour, Line, Peer, listening
from tests.faults.row import Row
from tests.interop.programs import free_port

TRIES = 5
OFFLINE_WITHIN, BACK_WITHIN = 0.3, 2.0
"""[s]"""
PATIENCE = 60.0
UNIT, FUNCTION = 6, 7
"""Places in a Modbus TCP frame."""


def _silent(line: Line, frame: bytes, reply: bytes) -> None:
    pass


def _garbled(line: Line, frame: bytes, reply: bytes) -> None:
    line.send(bytes(octet ^ 0x5A for octet in reply))


def _short(line: Line, frame: bytes, reply: bytes) -> None:
    line.send(reply[:-1])


def _wrong_unit(line: Line, frame: bytes, reply: bytes) -> None:
    line.send(reply[:UNIT] + bytes([reply[UNIT] + 1]) + reply[UNIT + 1 :])


def _wrong_function(line: Line, frame: bytes, reply: bytes) -> None:
    line.send(reply[:FUNCTION] + b"\x10" + reply[FUNCTION + 1 :])


def _another_answer(line: Line, frame: bytes, reply: bytes) -> None:
    """That of the request before."""
    transaction = int.from_bytes(reply[:2], "big") - 1
    line.send((transaction % 0x10000).to_bytes(2, "big") + reply[2:])


def _hung_up(line: Line, frame: bytes, reply: bytes) -> None:
    line.hang_up()


def _failing(line: Line, frame: bytes, reply: bytes) -> None:
    """Exception 4, server device failure."""
    line.send(frame[:4] + b"\x00\x03" + bytes([frame[UNIT], frame[FUNCTION] | 0x80, 4]))


Misbehaviour = Callable[[Line, bytes, bytes], None]
MISBEHAVIOURS: dict[str, Misbehaviour] = {
    "reply lost, peer silent": _silent,
    "reply garbled": _garbled,
    "reply short": _short,
    "reply of another unit": _wrong_unit,
    "reply to another function": _wrong_function,
    "reply of the request before": _another_answer,
    "connection closed": _hung_up,
    "exception 4": _failing,
}


@asynccontextmanager
async def _controlled(gripper: GripperSettings) -> AsyncIterator[tuple[Peer, Loop]]:
    async with (
        listening(_honest(_bench(gripper))) as peer,
        _looping(gripper, peer.port) as loop,
    ):
        yield peer, loop


def _bench(gripper: GripperSettings) -> BenchServer:
    assert gripper.input is not None
    modules = Modules(
        Rig(gripper.chain, Random(1)),
        (gripper.output.module, gripper.output.unit),
        (gripper.input.module, gripper.input.unit),
    )
    return BenchServer(modules, asyncio.get_running_loop().time)


@asynccontextmanager
async def _looping(gripper: GripperSettings, port: int) -> AsyncIterator[Loop]:
    ids = count()
    async with open_bus(TcpAddress(host="127.0.0.1", port=port)) as bus:
        loop = Loop(
            Gripper(
                "g0",
                gripper.chain,
                auto_enable=True,
                identify=lambda: f"{next(ids)}",
            ),
            AnalogRig(bus, gripper.output, gripper.input),
            period=1 / gripper.rate,
        )
        async with running(loop):
            yield loop


def _honest(bench: BenchServer) -> Behaviour:
    return lambda line, frame: line.send(bench.answer(frame))


def _wrong(bench: Behaviour, misbehave: Misbehaviour) -> Behaviour:
    """Answer as the bench does, but see that the answer arrives so."""

    def behave(line: Line, frame: bytes) -> None:
        said: list[bytes] = []
        bench(_Ear(said), frame)  # type: ignore[arg-type]
        misbehave(line, frame, said[0])

    return behave


class _Ear:
    """Hears what would be sent."""

    def __init__(self, said: list[bytes]) -> None:
        self._said = said

    def send(self, octets: bytes) -> None:
        self._said.append(octets)


async def _since(start: float, happened: Callable[[], bool]) -> float:
    async with asyncio.timeout(PATIENCE):
        while not happened():  # noqa: ASYNC110
            await asyncio.sleep(0.001)
    return time.monotonic() - start


async def _measured(
    gripper: GripperSettings, misbehave: Misbehaviour
) -> tuple[list[float], list[float]]:
    """Times to `offline`, and back to `ready`."""
    offline, back = [], []
    async with _controlled(gripper) as (peer, loop):
        honest = peer.behave
        for _ in range(TRIES):
            await _since(0.0, lambda: loop.gripper.machine is Machine.READY)
            start = time.monotonic()
            peer.behave = _wrong(honest, misbehave)
            offline.append(
                await _since(start, lambda: loop.gripper.machine is Machine.OFFLINE)
            )
            await asyncio.sleep(0.3)
            start = time.monotonic()
            peer.behave = honest
            back.append(
                await _since(start, lambda: loop.gripper.machine is Machine.READY)
            )
    return offline, back


async def _refused(gripper: GripperSettings) -> tuple[list[float], list[float]]:
    """The same for a port that nobody listens on, and then somebody does again."""
    offline, back = [], []
    behave, port = _honest(_bench(gripper)), free_port()
    async with AsyncExitStack() as stack:
        peer = await stack.enter_async_context(AsyncExitStack())
        await peer.enter_async_context(listening(behave, port))
        loop = await stack.enter_async_context(_looping(gripper, port))
        for _ in range(TRIES):
            await _since(0.0, lambda: loop.gripper.machine is Machine.READY)
            start = time.monotonic()
            await peer.aclose()
            offline.append(
                await _since(start, lambda: loop.gripper.machine is Machine.OFFLINE)
            )
            await asyncio.sleep(0.3)
            start = time.monotonic()
            await peer.enter_async_context(listening(behave, port))
            back.append(
                await _since(start, lambda: loop.gripper.machine is Machine.READY)
            )
    return offline, back


async def _rows() -> list[Row]:
    (gripper,) = load_settings(shipped("gripperd.yaml"), {}).grippers.values()
    measured = {
        name: await _measured(gripper, misbehave)
        for name, misbehave in MISBEHAVIOURS.items()
    }
    measured["port refused"] = await _refused(gripper)
    found = []
    for name, (offline, back) in measured.items():
        found += [
            Row(
                fault=name,
                noticed="offline",
                took=tuple(offline),
                limit=OFFLINE_WITHIN,
            ),
            Row(
                fault=f"{name}: over",
                noticed="adopted, ready",
                took=tuple(back),
                limit=BACK_WITHIN,
            ),
        ]
    return found


def rows() -> Iterator[Row]:
    """Each kind of wrong answer, from one moment on, and right ones again."""
    yield from uvloop.run(_rows())
