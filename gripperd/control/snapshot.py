"""What anybody may know about a gripper at one moment."""

from dataclasses import dataclass

from gripperd.control.fault import Fault
from gripperd.control.held import Held
from gripperd.control.regulation import RegulationState
from gripperd.control.states import Event, Grip, Machine
from gripperd.control.zero import UNTARED, Zero
from gripperd.signals import Measurement


@dataclass(frozen=True, slots=True)
class Instant:
    """One moment on both clocks."""

    monotonic: float
    """For control; never steps. [s]"""
    wall: float
    """For people and records; seconds since the epoch."""


@dataclass(frozen=True, slots=True, kw_only=True)
class GripperState:
    """A snapshot of everything, for whoever asks."""

    name: str
    machine: Machine
    grip: Grip
    available_transitions: tuple[Event, ...]
    adopted: bool
    """Whether the present current was found, not commanded."""
    current: float | None
    """Commanded valve current. [A]"""
    measured: Measurement | None
    age: float | None
    """Time since that measurement. [s]"""
    command: str | None
    """The command that runs."""
    holding: str | None
    """Profile of what is held."""
    link: str
    """``up``, or why there is none."""
    model: str
    """Name of the model that it goes by."""
    model_digest: str
    """What tells that from another of the same name."""
    held: Held | None = None
    """What is held and under which limits, where that is known."""
    strongest: float | None = None
    """Highest grip force since something has been held. [N]"""
    regulation: RegulationState | None = None
    """How its force is kept."""
    faults: tuple[Fault, ...] = ()
    """Those that still matter, oldest first."""
    zero: Zero = UNTARED
    """What the force sensor shows without a load."""
