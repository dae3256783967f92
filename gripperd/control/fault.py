"""One fault of a gripper, from its first symptom to its end."""

from dataclasses import dataclass
from enum import StrEnum

from gripperd.control.monitors.policy import Cause, Reaction


class Step(StrEnum):
    """What somebody has to do to leave a fault behind."""

    MEND = "mend"
    """Take its cause away."""
    ACKNOWLEDGE = "acknowledge"
    RESET = "reset"
    ENABLE = "enable"
    COMMAND = "command"
    """Give the next command: what is lost does not come back."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Fault:
    """A snapshot of one fault. Times are seconds since the epoch."""

    id: str
    gripper: str
    cause: Cause
    subject: str
    """Which one, where there are several, such as a channel."""
    message: str
    reaction: Reaction
    latched: bool
    """Whether it stops the gripper until it is acknowledged and reset."""
    raised_at: float
    cleared_at: float | None = None
    """When the cause was gone."""
    acknowledged_at: float | None = None
    acknowledged_by: str | None = None
    reset_at: float | None = None

    @property
    def active(self) -> bool:
        """Whether it still matters: its cause is there, or it is latched."""
        if self.latched:
            return self.reset_at is None
        return self.cleared_at is None

    @property
    def unseen(self) -> bool:
        """Whether somebody has to acknowledge it."""
        if self.cause is Cause.ESTOPPED:
            return False
        return self.latched and self.acknowledged_at is None

    @property
    def way_out(self) -> tuple[Step, ...]:
        """What is left to be done, in order; empty once it is over."""
        if not self.active:
            return ()
        mend = (Step.MEND,) if self.cleared_at is None else ()
        if not self.latched:
            return (Step.COMMAND,) if self.cause is Cause.PART_LOST else mend
        seen = (Step.ACKNOWLEDGE,) if self.unseen else ()
        return (*seen, *mend, Step.RESET, Step.ENABLE)
