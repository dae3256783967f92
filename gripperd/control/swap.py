"""Another model for grippers that run: for all of them between two periods, or none."""

from collections.abc import Sequence

from gripperd.control.gripper import Gripper
from gripperd.control.states import Machine
from gripperd.errors import Refused
from gripperd.model import Chain

AT_REST = frozenset({Machine.READY, Machine.DISABLED})
"""States in which the jaws stand still and it is known what they hold."""


def swap(grippers: Sequence[Gripper], chain: Chain) -> None:
    """Let grippers go by another model; no current is written by it.

    Raises
    ------
    Refused
        One of them moves, is about to, or may hold something; none was changed.
    """
    for gripper in grippers:
        _check(gripper)
    for gripper in grippers:
        gripper.use(chain)


def _check(gripper: Gripper) -> None:
    state = f"{gripper.name} is {gripper.machine}, {gripper.hold.grip}"
    if gripper.machine not in AT_REST or any(gripper.ledger.waiting()):
        message = f"{state}: its model stays as it is until it is at rest"
        hints = ("wait until its commands are over, or stop it",)
        raise Refused(message, code="wrong-state", hints=hints)
    if gripper.objection is not None:
        message = f"{state}: its model stays as it is while it may hold something"
        raise Refused(message, code="object-held", hints=("release first",))
