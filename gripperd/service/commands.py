"""Commands: give one, follow it, cancel it."""

import hashlib
import json
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Annotated, Literal, Self

from fastapi import Body, Depends, Header, Query, Request, Response
from pydantic import BaseModel, ConfigDict, Field, model_validator

from gripperd.config.section import Section
from gripperd.control.command import Command
from gripperd.control.evaluation import check
from gripperd.control.ledger import Key
from gripperd.errors import InputError, LinkError
from gripperd.link.client import Client
from gripperd.link.control import Cancel, ListCommands, ReadCommand, Submit, Submitted
from gripperd.service.body import disagreement, router
from gripperd.service.command_documents import (
    CommandDocument,
    Commands,
    command_document,
)
from gripperd.service.context import Daemon
from gripperd.service.preferences import Wait, Waiting
from gripperd.service.target import Target, order_for

GRACE = 5.0
"""How much longer than the wait itself its answer may take. [s]"""
DEFAULT_DEADLINE = 15.0
"""[s]"""
LONGEST_LIST = 200
"""So that a list fits into one message between the processes."""

routes = router("commands")

Seconds = Annotated[float, Field(ge=0.1, le=120)]


class ReleaseParams(Section):
    """How to open the jaws."""

    deadline_s: Seconds = Field(
        default=DEFAULT_DEADLINE,
        description="The command is over by then, come what may.",
    )


class GraspParams(Target, ReleaseParams):
    """What to grasp: a profile, or a size with a force or current."""

    profile: str | None = None


class _InEitherPlace(Section):
    """Params stand beside the type or in an object of their own."""

    @model_validator(mode="after")
    def _in_one_place(self) -> Self:
        given = self.model_fields_set - {"type"}
        if getattr(self, "params", None) is not None and given != {"params"}:
            message = "values stand in params or beside the type, not in both"
            raise disagreement(message)
        return self


class GraspRequest(GraspParams, _InEitherPlace):
    """Close the jaws on an object."""

    type: Literal["grasp"]
    params: GraspParams | None = None


class ReleaseRequest(ReleaseParams, _InEitherPlace):
    """Open the jaws."""

    type: Literal["release"]
    params: ReleaseParams | None = None


CommandRequest = Annotated[
    GraspRequest | ReleaseRequest, Field(discriminator="type"), Body()
]


async def _key(
    request: Request,
    idempotency_key: Annotated[str | None, Header(min_length=1, max_length=255)] = None,
) -> Key | None:
    """Bind a key to the request as it was sent: what it refers to may change."""
    if idempotency_key is None or not await request.body():
        return None
    sent = json.dumps([request.url.path, await request.json()], sort_keys=True)
    return Key(idempotency_key, hashlib.sha256(sent.encode()).hexdigest())


GivenKey = Annotated[Key | None, Depends(_key)]


@routes.post("/grippers/{gripper}/commands", status_code=201)
async def give_command(
    daemon: Daemon,
    gripper: str,
    asked: CommandRequest,
    key: GivenKey,
    wait: Wait,
    response: Response,
) -> CommandDocument:
    """Grasp or release; 200 instead of 201 when the key was used for it before."""
    order = None
    params = asked.params or asked
    if isinstance(asked, GraspRequest) and isinstance(params, GraspParams):
        chain = (await daemon.up_to_date(daemon.gripper(gripper))).chain
        with _within("params" if asked.params else ""):
            order = order_for(params.profile, params, chain, daemon.library)
        check(order, chain)
    submit = Submit(daemon.gripper(gripper).name, order, params.deadline_s, key)
    accepted = await daemon.change(submit, Submitted)
    command = accepted.command
    if accepted.replayed:
        response.status_code = 200
        response.headers["idempotency-replayed"] = "true"
    response.headers["location"] = f"/v1/grippers/{gripper}/commands/{command.id}"
    # The command is accepted, and its client must learn so, whatever comes now.
    with suppress(LinkError):
        command = await _followed(daemon.control, command, wait)
        _applied(wait, response)
    return command_document(command)


class ListQuery(BaseModel):
    """How much of the list."""

    model_config = ConfigDict(extra="forbid")

    limit: int = Field(default=20, ge=1, le=LONGEST_LIST)


@routes.get("/grippers/{gripper}/commands")
async def list_commands(
    daemon: Daemon, gripper: str, query: Annotated[ListQuery, Query()]
) -> Commands:
    """The last commands, newest first."""
    request = ListCommands(daemon.gripper(gripper).name, query.limit)
    found = await daemon.control.ask(request, list[Command])
    return Commands(commands=tuple(command_document(command) for command in found))


@routes.get("/grippers/{gripper}/commands/{id}")
async def read_command(
    daemon: Daemon, gripper: str, id: str, wait: Wait, response: Response
) -> CommandDocument:
    """One command, at once or when it is over."""
    name = daemon.gripper(gripper).name
    command = await _read(daemon.control, name, id, wait.seconds)
    _applied(wait, response)
    return command_document(command)


@routes.delete("/grippers/{gripper}/commands/{id}", status_code=202)
async def cancel_command(daemon: Daemon, gripper: str, id: str) -> CommandDocument:
    """End a command; if it runs, the jaws freeze as on a stop."""
    request = Cancel(daemon.gripper(gripper).name, id)
    return command_document(await daemon.change(request, Command))


async def _followed(control: Client, command: Command, wait: Waiting) -> Command:
    if command.final or not wait.seconds:
        return command
    return await _read(control, command.gripper, command.id, wait.seconds)


async def _read(control: Client, gripper: str, command: str, wait: float) -> Command:
    request = ReadCommand(gripper, command, wait)
    return await control.ask(request, Command, wait + GRACE)


def _applied(wait: Waiting, response: Response) -> None:
    if wait.applied:
        response.headers["preference-applied"] = wait.applied


@contextmanager
def _within(part: str) -> Iterator[None]:
    """Let the key of an error lead into a part of the body."""
    try:
        yield
    except InputError as error:
        if not part or error.key is None:
            raise
        raise type(error)(str(error), key=f"{part}/{error.key}") from error
