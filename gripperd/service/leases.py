"""Leases: who alone may give commands."""

import secrets
from datetime import datetime
from typing import Annotated

from fastapi import Depends, Header, Response
from pydantic import Field

from gripperd.config.section import Section
from gripperd.control.lease import Lease
from gripperd.link.lease import EndLease, LeaseState, ReadLease, TakeLease
from gripperd.service.body import router
from gripperd.service.context import Context, Daemon
from gripperd.service.rendering import Document, optional, timestamp, to

TOKEN_OCTETS = 16
"""More than anybody can guess."""

routes = router("leases")


async def _token(
    lease_token: Annotated[
        str | None,
        Header(max_length=200, description="What the lease was given with."),
    ] = None,
) -> str | None:
    return lease_token


LeaseToken = Annotated[str | None, Depends(_token)]
"""The token of a request, if it has one."""


class LeaseRequest(Section):
    """Whose lease, and for how long."""

    owner: str = Field(min_length=1, max_length=200, description="For the others.")
    ttl_s: float = Field(
        ge=0.5, le=3600, description="Renew it within this time, or what moves stops."
    )


class LeaseDocument(Document):
    """The lease of a gripper; null where nobody has it."""

    owner: str | None
    expires_at: datetime | None
    ttl_s: float | None
    token: str | None = optional("For its owner, as header Lease-Token.")


@routes.get("/grippers/{gripper}/lease")
async def read_lease(daemon: Daemon, gripper: str) -> LeaseDocument:
    """Who has the lease, and until when."""
    return _document(await _asked(daemon, ReadLease(daemon.gripper(gripper).name)))


@routes.put("/grippers/{gripper}/lease")
async def take_lease(
    daemon: Daemon,
    gripper: str,
    asked: LeaseRequest,
    token: LeaseToken,
    response: Response,
) -> LeaseDocument:
    """Take the lease, 201, or renew it with its token, 200; else 423 says who has it.

    When it runs out, what moves is frozen and what is held stays held.
    """
    name = daemon.gripper(gripper).name
    given = token or secrets.token_urlsafe(TOKEN_OCTETS)
    request = TakeLease(name, asked.owner, given, asked.ttl_s)
    lease = await _asked(daemon, request)
    response.status_code = 200 if token else 201
    return _document(lease, given)


@routes.delete("/grippers/{gripper}/lease")
async def end_lease(daemon: Daemon, gripper: str, token: LeaseToken) -> LeaseDocument:
    """Give the lease back; nothing moves, nothing stops."""
    request = EndLease(daemon.gripper(gripper).name, token)
    return _document(await _asked(daemon, request))


async def _asked(
    daemon: Context, request: ReadLease | TakeLease | EndLease
) -> Lease | None:
    return (await daemon.control.ask(request, LeaseState)).lease


def _document(lease: Lease | None, token: str | None = None) -> LeaseDocument:
    if lease is None:
        return LeaseDocument(owner=None, expires_at=None, ttl_s=None)
    return LeaseDocument(
        owner=lease.owner,
        expires_at=timestamp(lease.expires_at),
        ttl_s=to("s", lease.ttl),
        token=token,
    )
