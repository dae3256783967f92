"""What the service asks of the control process."""

from collections.abc import Callable
from math import inf
from typing import TypeAlias

import msgspec
import structlog

from gripperd.control.command import Command, GraspOrder
from gripperd.control.ledger import Key
from gripperd.control.loop import Loop
from gripperd.control.monitors.policy import Cause
from gripperd.control.swap import swap
from gripperd.control.task import Task
from gripperd.control.timing import Timing
from gripperd.errors import NotFound, Refused
from gripperd.link import faults, lease
from gripperd.link.buses import BusDesk, ReadBuses, ReadTraffic
from gripperd.link.frames import decode
from gripperd.link.journal import Page, ReadJournal, page
from gripperd.link.model import ModelMessage, chain_of, model_message

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
    timings: dict[str, Timing] = {}
    """How punctual the loop of each gripper has been."""
    unlogged: int = 0
    """Log lines that were dropped, because nobody took them in time."""
    ended: dict[str, dict[str, int]] = {}
    """How many commands of each gripper are over, by kind and status."""
    raised: dict[str, dict[Cause, int]] = {}
    """How many faults each gripper has had, by cause."""


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


class ReadModel(msgspec.Struct, frozen=True, tag=True):
    """Ask for the :class:`ModelMessage` that a gripper goes by."""

    gripper: str


class Submit(msgspec.Struct, frozen=True, tag=True):
    """Give a command, None for a release; the reply is :class:`Submitted`."""

    gripper: str
    order: GraspOrder | None
    deadline: float
    key: Key | None = None
    lease: str | None = None
    """Token of the lease that it is given under."""
    task: Task | None = None
    """What to do instead of a grasp or a release."""
    late: float | None = None
    """From then on the monotonic clock nobody waits for it: it is not begun. [s]"""


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
    lease: str | None = None


class Stop(msgspec.Struct, frozen=True, tag=True):
    """Freeze; never queues, never releases. The reply is a :class:`GripperState`."""

    gripper: str


class Enable(msgspec.Struct, frozen=True, tag=True):
    """Allow commands; the reply is a :class:`GripperState`."""

    gripper: str
    lease: str | None = None


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
    | ReadModel
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
    | ReadJournal
    | lease.Request
    | faults.Request
)
UnderLease: TypeAlias = Submit | Cancel | Enable | faults.Acknowledge | faults.Reset
"""What only the owner of the lease may ask, while somebody has one."""


class ControlDesk:
    """Answers the service on behalf of the loops and their buses."""

    def __init__(
        self,
        loops: dict[str, Loop],
        buses: BusDesk | None = None,
        *,
        real_time: bool,
        started_at: float,
        unlogged: Callable[[], int] = lambda: 0,
    ) -> None:
        self._loops = loops
        self._buses = buses or BusDesk({})
        self._real_time = real_time
        self._started_at = started_at
        self._unlogged = unlogged

    async def respond(self, body: msgspec.Raw) -> object:
        """Do what one request asks for."""
        request: Request = decode(body, Request)  # type: ignore[arg-type]
        if isinstance(request, ReadOverview):
            return self._overview()
        if isinstance(request, ReadBuses | ReadTraffic):
            return self._buses.respond(request)
        if isinstance(request, ReadModules):
            return {name: loop.facts for name, loop in self._loops.items()}
        if isinstance(request, ReadModel | UseModel):
            return self._model(request)
        if isinstance(request, ReadJournal):
            return await self._page(request)
        loop = self._loop(request.gripper)
        _check(request, loop)
        if isinstance(request, lease.Request):
            return lease.respond(request, loop.gripper, loop.present())
        if isinstance(request, faults.Request):
            return faults.respond(request, loop.gripper, loop.present())
        return await _respond(request, loop)

    def _model(self, request: ReadModel | UseModel) -> object:
        if isinstance(request, ReadModel):
            return model_message(self._loop(request.gripper).gripper.chain)
        loops = [self._loop(name) for name in request.grippers]
        swap([loop.gripper for loop in loops], chain_of(request.model))
        log.info("model", grippers=request.grippers, model=request.model.name)
        return [loop.state() for loop in loops]

    async def _page(self, request: ReadJournal) -> Page:
        loop, life = self._loop(request.gripper), self._started_at
        after = request.after if request.life == life else 0
        return page(await loop.follow(after, request.wait), life, after)

    def _overview(self) -> Overview:
        timings = {name: loop.timing() for name, loop in self._loops.items()}
        return Overview(
            grippers=tuple(self._loops),
            real_time=self._real_time,
            overruns=sum(timing.overruns for timing in timings.values()),
            started_at=self._started_at,
            timings=timings,
            unlogged=self._unlogged(),
            ended={
                name: dict(loop.gripper.ledger.ended)
                for name, loop in self._loops.items()
            },
            raised={
                name: dict(loop.gripper.faults.raised)
                for name, loop in self._loops.items()
            },
        )

    def _loop(self, name: str) -> Loop:
        if name not in self._loops:
            known = ", ".join(self._loops)
            message = f"there is no gripper {name!r}; there is {known}"
            raise NotFound(message, key="gripper")
        return self._loops[name]


async def _respond(request: Request, loop: Loop) -> object:
    match request:
        case Submit(_, order, deadline, key):
            asked = request.task or order
            return Submitted(*loop.submit(asked, deadline, key))
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


def _check(request: Request, loop: Loop) -> None:
    """Refuse what needs a lease without it, and what comes too late.

    Stop and disable need none: nothing moves by them, and they must always be possible.
    """
    now = loop.present()
    if isinstance(request, UnderLease):
        loop.gripper.permission.tenancy.check(request.lease, now)
    if isinstance(request, Submit) and (request.late or inf) <= now.monotonic:
        # Nobody waits for it any more, and somebody may have been told so.
        message = "the request came too late to be begun"
        raise Refused(message, code="too-late")
