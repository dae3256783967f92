"""Commands as documents: what was asked for, and what became of it."""

# ruff: noqa: N815  (names carry units, and units have capitals)

from datetime import datetime
from typing import TypeAlias

from pydantic import Field

from gripperd.config import profile_document
from gripperd.control.command import (
    Command,
    Failure,
    GraspOrder,
    GraspResult,
    Kind,
    Outcome,
    Status,
)
from gripperd.control.profile import Mode
from gripperd.control.task import (
    Adjust,
    Adopt,
    Checked,
    Move,
    Moved,
    Tared,
    Task,
)
from gripperd.service import assumption
from gripperd.service.rendering import (
    GIVEN,
    Document,
    known,
    optional,
    ratio,
    timestamp,
    to,
)
from gripperd.signals import Quality


class ParamsDocument(Document):
    """What was asked for, with everything that was left out filled in."""

    deadline_s: float
    profile: str | None = optional("Its name.")
    profile_version: int | None = optional("Which limits the grasp went by.")
    mode: Mode | None = optional("What the grasp aims at.")
    current_mA: float | None = optional("Target of mode current.")
    force_N: float | None = optional("Target of mode force, per jaw.")
    diameter_mm: float | None = optional("Expected size of the object.")
    opening_mm: float | None = optional("Where the empty jaws are to stand.")
    model: str | None = optional("Model the grasp was checked with.")
    assumed: dict[str, object] | None = optional(
        "The profile that was made up, when none was named."
    )


class ResultDocument(Document):
    """What was found at the end of a grasp; null where it is not known."""

    outcome: Outcome
    size_mm: float | None = Field(description="Opening at first contact.")
    opening_mm: float | None
    force_N: float | None = Field(description="Grip force per jaw.")
    force_quality: Quality
    predicted_force_N: float | None
    predicted_std_N: float | None
    current_mA: float
    pressure_kPa: float | None
    slip_margin: float | None = Field(description="Force over the slip limit.")
    crush_margin: float | None = Field(description="Damage limit over the force.")
    duration_s: float
    profile_version: int | None
    model: str | None


class MovedDocument(Document):
    """Where empty jaws came to rest; null where it is not known."""

    opening_mm: float | None
    error_mm: float | None = Field(description="From what was asked for.")
    current_mA: float


class TaredDocument(Document):
    """The zero of the force sensor, now taken off what it shows."""

    zero_N: float
    noise_N: float = Field(description="One sigma.")


class CheckedDocument(Document):
    """What a self-test measured; null where no sensor tells it."""

    valve_error_kPa: float | None = Field(description="More than was asked for.")
    rise_time_s: float | None = Field(description="To 63 % of the step.")
    droop_kPa_per_s: float | None = Field(description="While the current stood still.")
    pressure_noise_kPa: float | None = Field(description="One sigma.")
    force_noise_N: float | None = Field(description="One sigma.")
    force_quality: Quality


FindingDocument: TypeAlias = MovedDocument | TaredDocument | CheckedDocument


class FailureDocument(Document):
    """Why a command did not do what was asked."""

    category: str = Field(
        description="`outcome`, `precondition`, `fault` or `cancelled`."
    )
    code: str
    message: str


class CommandDocument(Document):
    """One command as it stands."""

    id: str
    gripper: str
    type: Kind
    status: Status
    params: ParamsDocument
    created_at: datetime
    started_at: datetime | None
    completed_at: datetime | None
    phase: str | None
    result: ResultDocument | FindingDocument | None
    error: FailureDocument | None
    log: tuple[str, ...]


class Commands(Document):
    """The last commands, newest first."""

    commands: tuple[CommandDocument, ...]


def command_document(command: Command) -> CommandDocument:
    """Describe a command for the outside."""
    started, completed = command.started_at, command.completed_at
    return CommandDocument(
        id=command.id,
        gripper=command.gripper,
        type=command.kind,
        status=command.status,
        params=_params(command),
        created_at=timestamp(command.created_at),
        started_at=None if started is None else timestamp(started),
        completed_at=None if completed is None else timestamp(completed),
        phase=command.phase or None,
        result=_outcome(command),
        error=_failure(command.error) if command.error else None,
        log=command.log,
    )


def _params(command: Command) -> ParamsDocument:
    order, deadline = command.order, command.deadline
    if order is None:
        return _task_params(command.task, deadline)
    profile, target = order.profile, order.target
    version = _version(order)
    in_current = order.mode is Mode.CURRENT
    return ParamsDocument(
        deadline_s=deadline,
        profile=profile.name if version else None,
        profile_version=version,
        mode=order.mode,
        current_mA=to("mA", target, GIVEN) if in_current else None,
        force_N=None if in_current else to("N", target, GIVEN),
        diameter_mm=to("mm", profile.diameter, GIVEN),
        model=order.model,
        assumed=None if version else profile_document(profile),
    )


def _task_params(task: Task | None, deadline: float) -> ParamsDocument:
    match task:
        case Adjust(force=float() as force):
            return ParamsDocument(deadline_s=deadline, force_N=to("N", force, GIVEN))
        case Adjust(current=float() as current):
            asked = to("mA", current, GIVEN)
            return ParamsDocument(deadline_s=deadline, current_mA=asked)
        case Adopt(profile=profile):
            return ParamsDocument(
                deadline_s=deadline,
                profile=profile.name,
                profile_version=profile.version,
            )
        case Move(opening=opening):
            asked = to("mm", opening, GIVEN)
            return ParamsDocument(deadline_s=deadline, opening_mm=asked)
        case _:
            return ParamsDocument(deadline_s=deadline)


def _outcome(command: Command) -> ResultDocument | FindingDocument | None:
    if command.result is not None:
        return _result(command.result, command.order)
    match command.finding:
        case Moved(opening=opening, error=error, current=current):
            return MovedDocument(
                opening_mm=known("mm", opening),
                error_mm=known("mm", error),
                current_mA=to("mA", current),
            )
        case Tared(zero=zero, noise=noise):
            return TaredDocument(zero_N=to("N", zero), noise_N=to("N", noise))
        case Checked() as found:
            return CheckedDocument(
                valve_error_kPa=known("kPa", found.valve_error),
                rise_time_s=known("s", found.rise_time),
                droop_kPa_per_s=known("kPa", found.droop),
                pressure_noise_kPa=known("kPa", found.pressure_noise),
                force_noise_N=known("N", found.force_noise),
                force_quality=found.force_quality,
            )
        case None:
            return None


def _version(order: GraspOrder) -> int | None:
    """Version of the profile, None when it was made up."""
    version = order.profile.version
    return None if version == assumption.VERSION else version


def _failure(failure: Failure) -> FailureDocument:
    return FailureDocument(
        category=failure.category, code=failure.code, message=failure.message
    )


def _result(result: GraspResult, order: GraspOrder | None) -> ResultDocument:
    return ResultDocument(
        outcome=result.outcome,
        size_mm=known("mm", result.size),
        opening_mm=known("mm", result.opening),
        force_N=known("N", result.force),
        force_quality=result.force_quality,
        predicted_force_N=known("N", result.predicted_force),
        predicted_std_N=known("N", result.predicted_std),
        current_mA=to("mA", result.current),
        pressure_kPa=known("kPa", result.pressure),
        slip_margin=ratio(result.slip_margin),
        crush_margin=ratio(result.crush_margin),
        duration_s=to("s", result.duration),
        profile_version=_version(order) if order else None,
        model=order.model if order else None,
    )
