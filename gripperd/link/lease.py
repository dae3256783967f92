"""What the service asks about the lease of a gripper."""

from typing import TypeAlias

import msgspec

from gripperd.control.gripper import Gripper
from gripperd.control.journal import Happening
from gripperd.control.lease import Lease
from gripperd.control.snapshot import Instant


class LeaseState(msgspec.Struct, frozen=True):
    """The lease that counts now, or None; the reply to all of these."""

    lease: Lease | None


class ReadLease(msgspec.Struct, frozen=True, tag=True):
    """Ask who has it."""

    gripper: str


class TakeLease(msgspec.Struct, frozen=True, tag=True):
    """Begin a lease, or renew it with its own token."""

    gripper: str
    owner: str
    token: str
    ttl: float


class EndLease(msgspec.Struct, frozen=True, tag=True):
    """End it before its time."""

    gripper: str
    token: str | None


Request: TypeAlias = ReadLease | TakeLease | EndLease


def respond(request: Request, gripper: Gripper, now: Instant) -> LeaseState:
    """Do what one request asks for.

    Raises
    ------
    Refused
        Somebody else has the lease.
    """
    tenancy, journal = gripper.permission.tenancy, gripper.ledger.journal
    match request:
        case TakeLease(_, owner, token, ttl):
            gripper.permission.expire(now)
            renewed = tenancy.lease(now) is not None
            tenancy.take(owner, token, ttl, now)
            if not renewed:
                text = f"{owner} took the lease for {ttl:g} s"
                journal.note(Happening.LEASE, text, now.wall)
        case EndLease(_, token):
            lease = tenancy.give_up(token, now)
            if lease is not None:
                text = f"{lease.owner} gave the lease back"
                journal.note(Happening.LEASE, text, now.wall)
        case ReadLease():
            pass
    return LeaseState(tenancy.lease(now))
