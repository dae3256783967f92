"""What the resources need, and how they get it."""

from asyncio import Lock
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Annotated, TypeVar

from fastapi import Depends, Request

from gripperd.config import GripperSettings, Settings
from gripperd.config.complaint import did_you_mean
from gripperd.control.snapshot import GripperState
from gripperd.control.states import Machine
from gripperd.errors import InputError, LinkError, NotFound, Refused
from gripperd.link.client import Client
from gripperd.link.control import (
    Cancel,
    Disable,
    Enable,
    ReadModel,
    ReadState,
    Stop,
    Submit,
)
from gripperd.link.faults import Reset
from gripperd.link.model import ModelMessage, chain_of
from gripperd.model import Chain
from gripperd.service.diagnosing import Diagnosing
from gripperd.service.fleet import Fleet
from gripperd.service.library import ProfileLibrary
from gripperd.service.past import Past
from gripperd.service.shared import Shared
from gripperd.service.state import StateDocument, state_document
from gripperd.store.recordings import Recordings

T = TypeVar("T")

STATE_LASTS = 5e-3
"""States are shared for half a period of the control loop. [s]"""
STATE_WITHIN = 1.0
"""Longest wait for a state; control answers in under a millisecond. [s]"""


@dataclass(frozen=True, slots=True)
class Seen:
    """A state, and the octets of its reply, made once for all who ask."""

    document: StateDocument
    json: bytes


@dataclass(frozen=True, slots=True, kw_only=True)
class Context:
    """The rest of the daemon, as the service sees it."""

    settings: Settings
    """As they were loaded; the grippers as they are now are the fleet."""
    fleet: Fleet
    control: Client
    bench: Client | None
    library: ProfileLibrary
    states: Shared[Seen]
    started_at: float
    """Seconds since the epoch."""
    version: str
    recordings: Recordings
    diagnosing: Diagnosing
    past: Past
    activating: Lock = field(default_factory=Lock)
    """One change of versions at a time, so that files and control agree."""
    reading: Lock = field(default_factory=Lock)
    """One recording is read at a time: reading takes a process."""

    def gripper(self, name: str) -> GripperSettings:
        """Settings of the gripper that a path names.

        Raises
        ------
        NotFound
            With the names there are.
        """
        if name not in self.fleet:
            hint = did_you_mean(name, self.fleet)
            message = f"there is no gripper {name!r}; {hint}"
            raise NotFound(message, key="gripper")
        return self.fleet[name]

    def chosen_gripper(self, name: str | None) -> GripperSettings:
        """Settings of the gripper that a body names; by default the first.

        Raises
        ------
        InputError
            With the names there are.
        """
        if name is None:
            return next(iter(self.fleet.values()))
        try:
            return self.gripper(name)
        except NotFound as error:
            raise InputError(str(error), key="gripper") from error

    async def up_to_date(self, gripper: GripperSettings) -> GripperSettings:
        """The same with the model that control goes by now.

        While control cannot be asked, the one it was last known to go by.
        """
        with suppress(LinkError):
            # The fleet follows every state that is read.
            await self.states.get(gripper.name)
        return self.fleet[gripper.name]

    @property
    def simulated(self) -> Client:
        """The bench.

        Raises
        ------
        Refused
            There is none on hardware.
        """
        if self.bench is None:
            message = "this daemon drives hardware; there is no bench to change"
            raise Refused(message, code="not-simulated")
        return self.bench

    async def change(
        self, request: Submit | Cancel | Stop | Enable | Disable | Reset, reply: type[T]
    ) -> T:
        """Ask control to do something with a gripper.

        Raises
        ------
        Refused
            What control refuses; with the cause, when the gripper has no link.
        """
        name = request.gripper
        try:
            return await self.control.ask(request, reply)
        except Refused as refused:
            if refused.code == "wrong-state":
                await self._check_link(name)
            raise
        finally:
            self.states.forget(name)

    async def _check_link(self, name: str) -> None:
        state = await self.control.ask(ReadState(name), GripperState, STATE_WITHIN)
        if state.machine is Machine.OFFLINE:
            message = f"{name} is offline: {state.link}"
            raise Refused(message, code="link-down")


def shared_states(fleet: Fleet, control: Client) -> Shared[Seen]:
    """Make the one place that asks control for states."""

    async def ask(name: str) -> Seen:
        state = await control.ask(ReadState(name), GripperState, STATE_WITHIN)
        document = state_document(state, await fleet.follow(state))
        return Seen(document, document.model_dump_json().encode())

    return Shared(ask, STATE_LASTS)


async def gone_by(control: Client, name: str) -> Chain:
    """Ask for the model that control goes by; raises what asking raises."""
    return chain_of(await control.ask(ReadModel(name), ModelMessage, STATE_WITHIN))


async def _context(request: Request) -> Context:
    context: Context = request.app.state.context
    return context


Daemon = Annotated[Context, Depends(_context)]
"""The context, as an argument of an operation."""
