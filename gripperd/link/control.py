"""What the service asks of the control process."""

from typing import TypeAlias

import msgspec
import structlog

from gripperd.control.command import Command, GraspOrder
from gripperd.control.ledger import Key
from gripperd.control.loop import Loop
from gripperd.control.swap import swap
from gripperd.errors import NotFound
from gripperd.link.buses import BusDesk, ReadBuses, ReadTraffic
from gripperd.link.frames import decode
from gripperd.link.model import ModelMessage, chain_of

log = structlog.get_logger()


class Overview(msgspec.Struct, frozen=True):
    """The control process itself."""

    grippers: tuple[str, ...]
    real_time: bool
    """Whether the control loop runs with real-time priority."""
    overruns: int
    """Periods that took too long, since the start."""
    started_at: float
    """Seconds since the epoch."""


class Submitted(msgspec.Struct, frozen=True):
    """An accepted command."""

    command: Command
    replayed: bool


class ReadOverview(msgspec.Struct, frozen=True, tag=True):
    """Ask for the :class:`Overview`."""


class ReadModules(msgspec.Struct, frozen=True, tag=True):
    """Ask for the :class:`RigFacts` of every gripper, by its name."""


class ReadState(msgspec.Struct, frozen=True, tag=True):
    """Ask for a :class:`GripperState`."""

    gripper: str


class Submit(msgspec.Struct, frozen=True, tag=True):
    """Give a command, None for a release; the reply is :class:`Submitted`."""

    gripper: str
    order: GraspOrder | None
    deadline: float
    key: Key | None = None


class ReadCommand(msgspec.Struct, frozen=True, tag=True):
    """Ask for a :class:`Command`, once it is over or ``wait`` seconds have passed."""

    gripper: str
    id: str
    wait: float = 0.0


class ListCommands(msgspec.Struct, frozen=True, tag=True):
    """Ask for a list of the last commands, newest first."""

    gripper: str
    count: int


class Cancel(msgspec.Struct, frozen=True, tag=True):
    """End one command; the reply is its last :class:`Command`."""

    gripper: str
    id: str


class Stop(msgspec.Struct, frozen=True, tag=True):
    """Freeze; never queues, never releases. The reply is a :class:`GripperState`."""

    gripper: str


class Enable(msgspec.Struct, frozen=True, tag=True):
    """Allow commands; the reply is a :class:`GripperState`."""

    gripper: str


class UseModel(msgspec.Struct, frozen=True, tag=True):
    """Let these grippers go by another model, all of them or none.

    The reply has a :class:`GripperState` of each.
    """

    grippers: tuple[str, ...]
    model: ModelMessage


class Disable(msgspec.Struct, frozen=True, tag=True):
    """Allow no more commands; the reply is a :class:`GripperState`."""

    gripper: str


Request: TypeAlias = (
    ReadOverview
    | ReadState
    | Submit
    | ReadCommand
    | ListCommands
    | Cancel
    | Stop
    | Enable
    | Disable
    | ReadBuses
    | ReadTraffic
    | ReadModules
    | UseModel
)


class ControlDesk:
    """Answers the service on behalf of the loops and their buses."""

    def __init__(
        self,
        loops: dict[str, Loop],
        buses: BusDesk | None = None,
        *,
        real_time: bool,
        started_at: float,
    ) -> None:
        self._loops = loops
        self._buses = buses or BusDesk({})
        self._real_time = real_time
        self._started_at = started_at

    async def respond(self, body: msgspec.Raw) -> object:
        """Do what one request asks for."""
        request: Request = decode(body, Request)  # type: ignore[arg-type]
        if isinstance(request, ReadOverview):
            overruns = sum(loop.overruns for loop in self._loops.values())
            names = tuple(self._loops)
            return Overview(names, self._real_time, overruns, self._started_at)
        if isinstance(request, ReadBuses | ReadTraffic):
            return self._buses.respond(request)
        if isinstance(request, ReadModules):
            return {name: loop.facts for name, loop in self._loops.items()}
        if isinstance(request, UseModel):
            loops = [self._loop(name) for name in request.grippers]
            swap([loop.gripper for loop in loops], chain_of(request.model))
            log.info("model", grippers=request.grippers, model=request.model.name)
            return [loop.state() for loop in loops]
        return await _respond(request, self._loop(request.gripper))

    def _loop(self, name: str) -> Loop:
        if name not in self._loops:
            known = ", ".join(self._loops)
            message = f"there is no gripper {name!r}; there is {known}"
            raise NotFound(message, key="gripper")
        return self._loops[name]


async def _respond(request: Request, loop: Loop) -> object:
    match request:
        case Submit(_, order, deadline, key):
            return Submitted(*loop.submit(order, deadline, key))
        case ReadCommand(_, command, wait):
            return await loop.wait(command, wait)
        case ListCommands(_, count):
            return loop.gripper.ledger.newest(count)
        case Cancel(_, command):
            return await loop.cancel(command)
        case Stop():
            return await loop.stop()
        case Enable():
            loop.enable()
        case Disable():
            loop.disable()
        case _:
            pass
    return loop.state()
