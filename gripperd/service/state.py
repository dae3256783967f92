"""The state of a gripper as a document; never an old value as if it were new."""

from datetime import datetime

from pydantic import Field

from gripperd.config import FailMode, GripperSettings
from gripperd.control.interlocks import closed
from gripperd.control.regulation import RegulationState
from gripperd.control.snapshot import GripperState
from gripperd.control.states import Event, Grip, Machine
from gripperd.control.trust import Level
from gripperd.errors import DomainError
from gripperd.model import Chain, PressedObject
from gripperd.service.fault_documents import FaultDocument, fault_document
from gripperd.service.hold_budget import BudgetDocument, hold_budget
from gripperd.service.rendering import Document, known, optional, timestamp, to
from gripperd.signals import Measurement, Quality, Reading
from gripperd.units import MILLI

# ruff: noqa: N815  (names carry units, and units have capitals)

STALE_AFTER = 0.5
"""A measurement that is older is not repeated. [s]"""


class Measured(Document):
    """A value with its credentials; its unit is in the key it stands under."""

    value: float | None = Field(description="Null unless there is one to believe.")
    quality: Quality
    age_ms: float | None = Field(description="Null when never measured.")
    cause: str | None = optional("Why the quality is not good.")


class MeasuredValues(Document):
    """Every channel, sampled together."""

    current_mA: Measured = Field(description="As the output module says it is.")
    pressure_kPa: Measured = Field(description="Gauge, in the muscle.")
    opening_mm: Measured
    force_N: Measured = Field(description="Grip force per jaw.")


class PresentPrediction(Document):
    """What the model says about the measured current and opening."""

    force_N: float = Field(description="Grip force per jaw while closing.")
    std_N: float = Field(description="Standard deviation, from the tolerances.")
    current_mA: float
    opening_mm: float


class RegulationDocument(Document):
    """How the force of what is held is kept."""

    level: Level = Field(description="What the pressure is corrected by.")
    quality: Quality = Field(
        description="Of the force; `substituted` while the model stands in for it."
    )
    cause: str | None = optional("Why the quality is not good.")
    wanted_N: float | None = Field(description="Null with a fixed current.")
    correction_kPa: float
    most_kPa: float = Field(description="Bound of the correction.")


class InterlocksDocument(Document):
    """Whether the contacts are closed; null: not fitted, or not known."""

    enable: bool | None = Field(description="False: no motion begins.")
    estop: bool | None = Field(description="False: pressed, or its wire is cut.")


class StateDocument(Document):
    """Everything about a gripper at one moment."""

    name: str
    machine: Machine
    grip: Grip
    available_transitions: tuple[Event, ...]
    link: str = Field(description="`up`, or why there is none.")
    holding: str | None = Field(description="Profile of what is held.")
    command: str | None = Field(description="Id of the command that runs.")
    current_mA: float | None = Field(description="Commanded; null while unknown.")
    adopted: bool = Field(description="The current was found, not commanded.")
    measured: MeasuredValues
    interlocks: InterlocksDocument
    faults: tuple[FaultDocument, ...] = Field(
        description="Those that still matter, oldest first."
    )
    prediction: PresentPrediction | None = Field(
        description="Null unless current, opening and model are known."
    )
    regulation: RegulationDocument | None = Field(
        description="Null unless an object is held under a profile."
    )
    hold_budget: BudgetDocument | None = Field(
        description="Null unless something is held, and it is known how hard."
    )
    zero_N: float = Field(description="Taken off what the force sensor shows.")
    tared_at: datetime | None = Field(description="When; null: never tared.")
    fail_mode: FailMode = Field(description="What happens without power or air.")
    model: str = Field(description="Name of the version that it goes by.")


def state_document(state: GripperState, settings: GripperSettings) -> StateDocument:
    """Describe a gripper for the outside."""
    fresh = state.age is not None and state.age <= STALE_AFTER
    return StateDocument(
        name=state.name,
        machine=state.machine,
        grip=state.grip,
        available_transitions=state.available_transitions,
        link=state.link,
        holding=state.holding,
        command=state.command,
        current_mA=known("mA", state.current),
        adopted=state.adopted,
        measured=MeasuredValues(
            current_mA=_measured("current", "mA", state),
            pressure_kPa=_measured("pressure", "kPa", state),
            opening_mm=_measured("opening", "mm", state),
            force_N=_measured("grip", "N", state),
        ),
        interlocks=_interlocked(state.measured if fresh else None),
        faults=tuple(map(fault_document, state.faults)),
        prediction=_predicted(state, settings.chain) if fresh else None,
        regulation=_regulated(state.regulation),
        hold_budget=hold_budget(state, settings),
        zero_N=to("N", state.zero.force),
        tared_at=timestamp(taken) if (taken := state.zero.taken_at) else None,
        fail_mode=settings.fail_mode,
        model=state.model,
    )


def _interlocked(measured: Measurement | None) -> InterlocksDocument:
    if measured is None:
        return InterlocksDocument(enable=None, estop=None)
    return InterlocksDocument(
        enable=_contact(measured.enable), estop=_contact(measured.estop)
    )


def _contact(reading: Reading) -> bool | None:
    return None if reading.quality is Quality.ABSENT else closed(reading)


def _regulated(found: RegulationState | None) -> RegulationDocument | None:
    if found is None:
        return None
    return RegulationDocument(
        level=found.level,
        quality=found.quality,
        cause=found.cause or None,
        wanted_N=known("N", found.wanted),
        correction_kPa=to("kPa", found.correction),
        most_kPa=to("kPa", found.most),
    )


def _measured(channel: str, unit: str, state: GripperState) -> Measured:
    if state.measured is None or state.age is None:
        cause = f"never measured: {state.link}"
        return Measured(value=None, quality=Quality.STALE, age_ms=None, cause=cause)
    reading: Reading = getattr(state.measured, channel)
    age = round(state.age / MILLI, 1)
    if state.age > STALE_AFTER and reading.quality is not Quality.ABSENT:
        cause = f"not measured for {state.age:.1f} s: {state.link}"
        return Measured(value=None, quality=Quality.STALE, age_ms=age, cause=cause)
    return Measured(
        value=known(unit, reading.value),
        quality=reading.quality,
        age_ms=age,
        cause=reading.cause or None,
    )


def _predicted(state: GripperState, chain: Chain) -> PresentPrediction | None:
    measured = state.measured
    if measured is None or state.model_digest != chain.digest:
        return None
    current, opening = measured.current.value, measured.opening.value
    if current is None or opening is None:
        return None
    try:
        force = float(chain.grip_force(current, opening))
        std = chain.std(current, PressedObject(opening))
    except DomainError:
        return None
    return PresentPrediction(
        force_N=to("N", max(force, 0.0)),
        std_N=to("N", std),
        current_mA=to("mA", current),
        opening_mm=to("mm", opening),
    )
