"""How a command ends."""

from dataclasses import dataclass

from gripperd.control.command import Failure, GraspResult
from gripperd.control.held import Held
from gripperd.control.states import Grip
from gripperd.control.task import Finding


@dataclass(frozen=True, slots=True)
class Ending:
    """What a command leaves behind."""

    grip: Grip | None
    """None: what is seen between the jaws decides."""
    result: GraspResult | None = None
    failure: Failure | None = None
    held: Held | None = None
    """What is held from now on, if that is the grip; None where it is not known."""
    finding: Finding | None = None
    """What came of a task that is no grasp."""
