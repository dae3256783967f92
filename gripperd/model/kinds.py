"""What the effects of one stage have in common: bases that fill in the port."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import ClassVar, Self

import numpy as np

from gripperd.model.effect import MuscleState, Signal, Stage
from gripperd.model.muscle import Muscle
from gripperd.model.real import Real
from gripperd.model.track import Array, Track


class Memoryless:
    """Nothing of the past matters, nor does the way or the clock."""

    __slots__ = ()
    turns: ClassVar[str] = ""
    timed: ClassVar[bool] = False
    one_sided: ClassVar[bool] = False
    basis: ClassVar[str] = ""
    idle: ClassVar[Mapping[str, tuple[str, ...]]] = MappingProxyType({})
    rests_on: ClassVar[Mapping[str, str]] = MappingProxyType({})
    travelling: ClassVar[frozenset[str]] = frozenset()
    unusual: ClassVar[frozenset[str]] = frozenset()

    @property
    def becomes(self) -> str:
        """None: it stays what it is."""
        return ""

    @property
    def is_misnamed(self) -> bool:
        """It is what it is called."""
        return False

    @property
    def forgetful(self) -> Self:
        """It stays what it is."""
        return self

    def rest(self) -> Array:
        """No memory."""
        return np.empty(0)


class InMuscle(Memoryless):
    """It adds a force that depends on the moment alone, unless it says otherwise."""

    __slots__ = ()
    stage: ClassVar[Stage] = Stage.MUSCLE

    @property
    def signal(self) -> Signal:
        """The pull."""
        return Signal.FORCE

    @property
    def affine(self) -> bool:
        """The force is affine in pressure between its kinks."""
        return True

    def force(self, at: MuscleState, muscle: Muscle) -> Real:
        """Force once all has settled: none. [N]."""
        return 0.0 * at.contraction

    def kinks(
        self, contraction: Real, diameter_ratio: Real, muscle: Muscle
    ) -> tuple[Real, ...]:
        """None: the force is smooth in pressure."""
        return ()

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Add the force of each moment."""
        return np.asarray(value + self.force(track.state, track.muscle))


class InValve(Memoryless):
    """It turns a pressure into another, unless it says otherwise."""

    __slots__ = ()
    stage: ClassVar[Stage] = Stage.VALVE

    @property
    def signal(self) -> Signal:
        """The pressure behind the regulator."""
        return Signal.PRESSURE

    def settled(self, pressure: Real, span: tuple[float, float]) -> Real:
        """Steady pressure: unchanged. [Pa]."""
        return pressure

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Pressure of each moment, as when it is steady. [Pa]."""
        return np.asarray(self.settled(value, track.span))


class InGripper(Memoryless):
    """It takes from the grip or moves the jaws."""

    __slots__ = ()
    stage: ClassVar[Stage] = Stage.GRIPPER

    @property
    def leans(self) -> bool:
        """Nothing rubs."""
        return False

    @property
    def stiffens(self) -> bool:
        """What bends, if any, does so in proportion."""
        return False

    def widening(self, grip: Real, pull: Real) -> Real:
        """None: the jaws stand where the linkage says. [m]."""
        return 0.0 * grip

    def hidden_contraction(self, pull: Real) -> Real:
        """None: the muscle is as short as measured. [-]."""
        return 0.0 * pull

    def transmitted(self, grip: Real, direction: Real) -> Real:
        """Grip force it leaves once settled: all. [N]."""
        return grip

    def taken(self, pull: Real, direction: Real) -> Real:
        """None on top. [N]."""
        return 0.0 * pull


class InSensor(Memoryless):
    """It changes what is read, not what is."""

    __slots__ = ()
    stage: ClassVar[Stage] = Stage.SENSOR
