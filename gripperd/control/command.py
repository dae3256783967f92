"""Commands: what a client asked for, and what became of it."""

from dataclasses import dataclass
from enum import StrEnum

from gripperd.control.profile import Mode, Profile
from gripperd.errors import GripperdError
from gripperd.signals import Quality


class Kind(StrEnum):
    """What a command does."""

    GRASP = "grasp"
    RELEASE = "release"


class Status(StrEnum):
    """Where a command stands; the last three are final."""

    QUEUED = "queued"
    RUNNING = "running"
    SUCCEEDED = "succeeded"
    FAILED = "failed"
    CANCELLED = "cancelled"


FINAL = frozenset({Status.SUCCEEDED, Status.FAILED, Status.CANCELLED})


class Outcome(StrEnum):
    """What came of a grasp."""

    HELD = "held"
    NO_OBJECT = "no_object"
    TOO_SMALL = "too_small"
    TOO_LARGE = "too_large"
    FORCE_NOT_REACHED = "force_not_reached"
    SLIPPED = "slipped"
    CRUSH_LIMIT = "crush_limit"
    UNKNOWN = "unknown"
    """The sensors that would tell are missing or broken."""


@dataclass(frozen=True, slots=True, kw_only=True)
class GraspOrder:
    """Grasp an object as its profile says; target and mode are already resolved."""

    profile: Profile
    mode: Mode
    target: float
    """Valve current [A] or grip force per jaw [N], as the mode says."""
    model: str
    """Name of the model it was checked with; once it runs, of the one it goes by."""


@dataclass(frozen=True, slots=True, kw_only=True)
class GraspResult:
    """What was measured at the end of a grasp. SI values, None where unknown."""

    outcome: Outcome
    size: float | None = None
    """Opening at first contact. [m]"""
    opening: float | None = None
    """Opening at the end. [m]"""
    force: float | None = None
    """Measured grip force per jaw. [N]"""
    force_quality: Quality = Quality.GOOD
    predicted_force: float | None = None
    """What the model says at this current and opening. [N]"""
    predicted_std: float | None = None
    """Its standard deviation. [N]"""
    current: float
    """Valve current at the end. [A]"""
    pressure: float | None = None
    """Gauge pressure in the muscle. [Pa]"""
    slip_margin: float | None = None
    """Force over the least force that carries the object. [-]"""
    crush_margin: float | None = None
    """Damage limit over force. [-]"""
    duration: float
    """From start to verdict. [s]"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Failure:
    """Why a command did not do what was asked."""

    category: str
    """``outcome``, ``precondition``, ``cancelled`` or ``fault``."""
    code: str
    message: str


STOPPED = Failure(category="cancelled", code="stopped", message="stopped")
CANCELLED = Failure(category="cancelled", code="cancelled", message="cancelled")
OBJECT_HELD = Failure(
    category="precondition", code="object-held", message="an object is held by then"
)


def no_answer(error: GripperdError) -> Failure:
    """The model has no answer to what the sensors say."""
    return Failure(category="fault", code="no-answer", message=str(error))


@dataclass(frozen=True, slots=True, kw_only=True)
class Command:
    """A snapshot of one command. Times are seconds since the epoch."""

    id: str
    gripper: str
    kind: Kind
    order: GraspOrder | None
    """What to grasp; None for a release."""
    status: Status
    created_at: float
    deadline: float
    """Longest time from creation to a final status. [s]"""
    due: float
    """End of that time on the monotonic clock. [s]"""
    started_at: float | None = None
    completed_at: float | None = None
    phase: str = ""
    result: GraspResult | None = None
    error: Failure | None = None
    log: tuple[str, ...] = ()

    @property
    def final(self) -> bool:
        """Whether nothing more will happen."""
        return self.status in FINAL
