"""Commands: give one, follow it, cancel it."""

import hashlib
import json
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Annotated, NamedTuple

from fastapi import Depends, Header, Query, Request, Response
from pydantic import BaseModel, ConfigDict, Field

from gripperd.control.command import Command
from gripperd.control.evaluation import check
from gripperd.errors import InputError, LinkError
from gripperd.link.control import Cancel, Submit
from gripperd.service.body import router
from gripperd.service.command_documents import (
    CommandDocument,
    Commands,
    command_document,
)
from gripperd.service.command_requests import (
    CommandRequest,
    GraspParams,
    GraspRequest,
    ReleaseRequest,
    task_for,
)
from gripperd.service.context import Context, Daemon
from gripperd.service.leases import LeaseToken
from gripperd.service.preferences import Wait, Waiting
from gripperd.service.target import order_for

LONGEST_LIST = 200
"""So that a list fits into one message between the processes."""

routes = router("commands")


class Terms(NamedTuple):
    """What a command is given under, besides what it says."""

    key: str | None
    """The client's idempotency key."""
    fingerprint: str
    """Digest of the request that the key stands for."""
    lease: str | None
    """Token of the client's lease."""


async def _terms(
    request: Request,
    lease: LeaseToken,
    idempotency_key: Annotated[str | None, Header(min_length=1, max_length=255)] = None,
) -> Terms:
    """Bind a key to the request as it was sent: what it refers to may change."""
    if not await request.body():
        return Terms(None, "", lease)
    sent = json.dumps([request.url.path, await request.json()], sort_keys=True)
    return Terms(idempotency_key, hashlib.sha256(sent.encode()).hexdigest(), lease)


GivenTerms = Annotated[Terms, Depends(_terms)]


@routes.post("/grippers/{gripper}/commands", status_code=201)
async def give_command(
    daemon: Daemon,
    gripper: str,
    asked: CommandRequest,
    terms: GivenTerms,
    wait: Wait,
    response: Response,
) -> CommandDocument:
    """Grasp, release, adjust and the like; on disk before it begins.

    200 instead of 201: the key was used for it before. 202: the disk fails, and
    without a key it is carried out all the same.
    """
    submit = await _submit(daemon, gripper, asked, terms)
    given = await daemon.past.submissions.give(
        submit, terms.key, terms.fingerprint, daemon.change
    )
    if given.replayed:
        response.status_code = 200
        response.headers["idempotency-replayed"] = "true"
    elif not given.recorded:
        response.status_code = 202
    command = given.command
    response.headers["location"] = f"/v1/grippers/{gripper}/commands/{command.id}"
    # The command is accepted, and its client must learn so, whatever comes now.
    with suppress(LinkError):
        if wait.seconds and command.completed_at is None:
            command = await daemon.past.command(gripper, command.id, wait.seconds)
        _applied(wait, response)
    return command


async def _submit(
    daemon: Context, gripper: str, asked: CommandRequest, terms: Terms
) -> Submit:
    """What to give to control; a grasp that cannot go well is refused here."""
    name = daemon.gripper(gripper).name
    params = asked.params or asked
    order, task = None, None
    if not isinstance(asked, ReleaseRequest):
        chain = (await daemon.up_to_date(daemon.gripper(gripper))).chain
        with _within("params" if asked.params else ""):
            if not isinstance(asked, GraspRequest):
                task = task_for(asked, chain, daemon.library)
            elif isinstance(params, GraspParams):
                order = order_for(params.profile, params, chain, daemon.library)
        if order is not None:
            check(order, chain)
    return Submit(name, order, params.deadline_s, lease=terms.lease, task=task)


class ListQuery(BaseModel):
    """How much of the list."""

    model_config = ConfigDict(extra="forbid")

    limit: int = Field(default=20, ge=1, le=LONGEST_LIST)


@routes.get("/grippers/{gripper}/commands")
async def list_commands(
    daemon: Daemon, gripper: str, query: Annotated[ListQuery, Query()]
) -> Commands:
    """The last commands, newest first."""
    name = daemon.gripper(gripper).name
    return Commands(commands=tuple(await daemon.past.commands(name, query.limit)))


@routes.get("/grippers/{gripper}/commands/{id}")
async def read_command(
    daemon: Daemon, gripper: str, id: str, wait: Wait, response: Response
) -> CommandDocument:
    """One command, at once or when it is over."""
    name = daemon.gripper(gripper).name
    command = await daemon.past.command(name, id, wait.seconds)
    _applied(wait, response)
    return command


@routes.delete("/grippers/{gripper}/commands/{id}", status_code=202)
async def cancel_command(
    daemon: Daemon, gripper: str, id: str, lease: LeaseToken
) -> CommandDocument:
    """End a command; if it runs, the jaws freeze as on a stop."""
    request = Cancel(daemon.gripper(gripper).name, id, lease)
    return command_document(await daemon.change(request, Command))


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
