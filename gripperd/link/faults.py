"""What the service asks about the faults of a gripper."""

from typing import TypeAlias

import msgspec

from gripperd.control.fault import Fault
from gripperd.control.gripper import Gripper
from gripperd.control.snapshot import GripperState, Instant


class ListFaults(msgspec.Struct, frozen=True, tag=True):
    """Ask for a list of the last :class:`Fault`, newest first."""

    gripper: str
    count: int


class Acknowledge(msgspec.Struct, frozen=True, tag=True):
    """Somebody has seen a fault; the reply is the :class:`Fault`."""

    gripper: str
    id: str
    who: str
    lease: str | None = None
    """Token of the lease that it is done under."""


class Reset(msgspec.Struct, frozen=True, tag=True):
    """Leave a fault for `disabled`; the reply is a :class:`GripperState`."""

    gripper: str
    lease: str | None = None


Request: TypeAlias = ListFaults | Acknowledge | Reset


def respond(
    request: Request, gripper: Gripper, now: Instant
) -> list[Fault] | Fault | GripperState:
    """Do what one request asks for.

    Raises
    ------
    NotFound, Refused
        There is no such fault; or it cannot be reset yet.
    """
    match request:
        case ListFaults(_, count):
            return gripper.faults.newest(count)
        case Acknowledge(_, fault_id, who):
            return gripper.faults.acknowledge(fault_id, who, now)
        case Reset():
            gripper.reset(now)
            return gripper.state(now)
