"""The port between the textbook and what it leaves out.

An effect changes one signal of the chain: the pressure behind the regulator, the pull
of the muscle, the jaws, or what a sensor says of any of them. The rubber of eq. (5)
and the friction of eq. (6) are effects like any other. Every effect is a frozen
dataclass whose numbers are declared by :mod:`gripperd.model.parameter`.
"""

from collections.abc import Mapping
from dataclasses import Field
from enum import IntEnum, StrEnum
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Protocol, Self, TypeGuard

from gripperd.model.real import Real

if TYPE_CHECKING:
    from gripperd.model.muscle import Muscle
    from gripperd.model.track import Array, Track

ROOM = 293.15
"""Temperature at which the constants of a muscle hold unless said otherwise. [K]"""


class Stage(StrEnum):
    """Where in the chain an effect acts."""

    VALVE = "valve"
    MUSCLE = "muscle"
    GRIPPER = "gripper"
    SENSOR = "sensor"


class Signal(StrEnum):
    """What is measured along the chain."""

    PRESSURE = "pressure"
    CONTRACTION = "contraction"
    FORCE = "force"
    OPENING = "opening"
    GRIP = "grip"


class Direction(IntEnum):
    """Direction of travel; dry friction keeps its sign at rest, so it is state."""

    EXTENDING = -1
    CONTRACTING = 1


class MuscleState(NamedTuple):
    """What the pull of a muscle may depend on at one moment."""

    pressure: Real
    """Gauge pressure in the bladder. [Pa]"""
    contraction: Real
    """Shortening relative to rest. [-]"""
    diameter_ratio: Real
    """Diameter relative to rest at this contraction. [-]"""
    direction: Real
    """+1 contracting, -1 extending, as :class:`Direction`."""
    rate: Real = 0.0
    """Of contraction. [1/s]"""
    temperature: Real = ROOM
    """Of the muscle. [K]"""
    cycle: Real = 0.0
    """Inflations so far. [-]"""


class Effect(Protocol):
    """One physical phenomenon."""

    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]
    name: ClassVar[str]
    """Standard name, as in model files and verdicts."""
    stage: ClassVar[Stage]
    needs: ClassVar[frozenset[str]]
    """Columns of a recording without which it cannot be seen."""
    shows: ClassVar[str]
    """How it shows in measurements, for a person."""
    confused_with: ClassVar[tuple[str, ...]]
    """Names of effects that look alike in many recordings."""
    remedy: ClassVar[str]
    """What a person can do about it, one sentence."""
    turns: ClassVar[str]
    """What must have gone both ways for it to be told from what has no memory; empty
    where nothing must."""
    timed: ClassVar[bool]
    """Whether time or order counts, beside what it remembers."""
    one_sided: ClassVar[bool]
    """Whether all its amplitudes have one sign, be it this or that."""
    basis: ClassVar[str]
    """Name of the effect it departs from, empty for none."""
    idle: ClassVar[Mapping[str, tuple[str, ...]]]
    """Parameters that a word it may choose leaves without a meaning."""
    rests_on: ClassVar[Mapping[str, str]]
    """Name of the effect that a word it may choose is about."""
    travelling: ClassVar[frozenset[str]]
    """Words it may choose that mean something of their own only in a travel."""
    unusual: ClassVar[frozenset[str]]
    """Words it may choose by which the rest of the model means what it seldom does."""

    @property
    def becomes(self) -> str:
        """Name of the effect that it is at the limits of its numbers, if another."""
        ...

    @property
    def is_misnamed(self) -> bool:
        """Whether its numbers lie where nothing is that bears its name."""
        ...

    @property
    def forgetful(self) -> Self:
        """The same without a memory, where something is left of it: a curve."""
        ...

    @property
    def signal(self) -> Signal:
        """The signal it changes."""
        ...

    def rest(self) -> "Array":
        """Memory before the first sample; empty when it remembers nothing.

        With an empty one, what it does to a sample depends on that sample alone: the
        samples before it may be of another run.
        """
        ...

    def along(self, value: "Array", track: "Track", memory: "Array") -> "Array":
        """Signal with the effect, from the signal without it.

        Parameters
        ----------
        value
            The signal so far, shape ``(n,)``. [SI]
        track
            What the rig goes through meanwhile.
        memory
            As :meth:`rest` gave it or the call before left it; it is moved on.
        """
        ...


class StaticEffect(Protocol):
    """What a muscle at standstill needs to know of an effect."""

    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]
    name: ClassVar[str]

    @property
    def affine(self) -> bool:
        """Whether the force is affine in pressure between its kinks."""
        ...

    def force(self, at: MuscleState, muscle: "Muscle") -> Real:
        """Force added to the ideal pull once settled, positive when it pulls. [N]."""
        ...

    def kinks(
        self, contraction: Real, diameter_ratio: Real, muscle: "Muscle"
    ) -> tuple[Real, ...]:
        """Gauge pressures at which the slope of the force in p changes. [Pa].

        Between its kinks an affine force makes the inverse problem closed.
        """
        ...


class MuscleEffect(Effect, StaticEffect, Protocol):
    """It changes the pull of a muscle."""


class ValveEffect(Effect, Protocol):
    """It changes the pressure behind the regulator."""

    def settled(self, pressure: Real, span: tuple[float, float]) -> Real:
        """Pressure it leaves of a steady one, with the ends of the line. [Pa]."""
        ...


class GripperEffect(Effect, Protocol):
    """It changes the opening or the grip."""

    @property
    def leans(self) -> bool:
        """Whether what rubs goes the way of the load, for jaws hardly travel."""
        ...

    @property
    def stiffens(self) -> bool:
        """Whether what bends gives less the more of its load there is."""
        ...

    def transmitted(self, grip: Real, direction: Real) -> Real:
        """Grip force it leaves of one, once settled, in proportion to it. [N]."""
        ...

    def taken(self, pull: Real, direction: Real) -> Real:
        """Grip force it takes on top, once settled, in proportion to the pull. [N]."""
        ...

    def widening(self, grip: Real, pull: Real) -> Real:
        """Opening beyond what the linkage says, of each load a part of its own. [m].

        Parameters
        ----------
        grip
            Force of each jaw, not below 0. [N]
        pull
            Of the muscle, not below 0. [N]
        """
        ...

    def hidden_contraction(self, pull: Real) -> Real:
        """Contraction of the muscle beyond what is measured, at a pull. [-]."""
        ...


class SensorEffect(Effect, Protocol):
    """It changes what a sensor says, not what is."""

    def truth(self, reading: "Array", track: "Track") -> "Array":
        """Undo :meth:`along`: what is, from what the sensor says. [SI]."""
        ...


def acts_in_muscle(effect: Effect) -> TypeGuard[MuscleEffect]:
    """Tell whether it changes the pull of the muscle."""
    return effect.stage is Stage.MUSCLE


def acts_in_valve(effect: Effect) -> TypeGuard[ValveEffect]:
    """Tell whether it changes the pressure behind the regulator."""
    return effect.stage is Stage.VALVE


def acts_in_gripper(effect: Effect) -> TypeGuard[GripperEffect]:
    """Tell whether it changes the opening or the grip."""
    return effect.stage is Stage.GRIPPER


def acts_in_sensor(effect: Effect) -> TypeGuard[SensorEffect]:
    """Tell whether it changes what is read."""
    return effect.stage is Stage.SENSOR
