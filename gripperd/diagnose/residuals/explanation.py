"""An explanation: a model, its constants, and the effects thought to act."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from enum import StrEnum

from gripperd.model import Linkage, Muscle, Regulator
from gripperd.model.effect import (
    Effect,
    SensorEffect,
    Signal,
    Stage,
    acts_in_gripper,
    acts_in_sensor,
)


class AtRest(StrEnum):
    """Sign of dry friction where nothing travels: the model leaves it open."""

    CARRIED = "carried"
    """As the rig came there: in a sweep without travel unknown, but one throughout."""
    INFLATING = "inflating"
    """It turns with the pressure."""
    YIELDING = "yielding"
    """So it does, but what sticks yields a while before it slips."""
    BLADDER = "bladder"
    """That of the bladder in its braid turns with the pressure, for it slides there;
    what rubs elsewhere stays as the rig came."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Explanation:
    """A model, its constants, and the effects thought to act."""

    muscle: Muscle
    regulator: Regulator | None
    linkage: Linkage | None
    effects: tuple[Effect, ...]
    at_rest: AtRest = AtRest.CARRIED
    winding: float = 0.0
    """Half the way back of what a frame that yields holds, which turns its friction
    round; 0 where its pressure does. [-]"""
    fading: float = 0.0
    """Time in which what rubs nears nothing by e where it rests; 0 where it keeps its
    sign. [s]"""
    zeros: Mapping[Signal, float] = field(default_factory=dict)
    """Small zero errors of sensors, within what any sensor has. [SI]"""
    rests: Mapping[int, float] = field(default_factory=dict)
    """Sign of friction in sweeps without travel, by index of the course. [-1..1]"""
    stiction: float = 0.0
    """By how much better friction holds what rests than what slides. [-]"""
    skews: Mapping[Signal, float] = field(default_factory=dict)
    """How much earlier than the force a channel is sampled. [s]"""
    vents: float | None = None
    """Pressure of a regulator that is asked for nothing, whatever its line; none where
    it keeps its line. [Pa]"""
    response: float = 0.0
    """Lag that any regulator has. [s]"""
    told_length: float | None = None
    """Rest length to which the recorded contraction refers, when another. [m]"""
    told_by: Linkage | None = None
    """That through which an opening was told as a contraction, when it was."""

    def sensors(self) -> "tuple[SensorEffect, ...]":
        """Effects that change what is read."""
        return tuple(effect for effect in self.effects if acts_in_sensor(effect))

    def tells(self, signal: Signal) -> bool:
        """Whether there are parts that a signal follows from."""
        match signal:
            case Signal.PRESSURE:
                return self.regulator is not None
            case Signal.OPENING:
                return self.linkage is not None and self.told_by is None
            case Signal.GRIP:
                return self.linkage is not None
            case _:
                return True

    def felt(self, moved: frozenset[Signal], *, is_blind: bool) -> frozenset[Signal]:
        """Signals that change with some.

        A contraction that the jaws tell goes with the opening, and the pull with it; a
        pull that no cell tells is felt in the grip.
        """
        if self.told_by is not None and Signal.OPENING in moved:
            moved |= {Signal.FORCE, Signal.GRIP}
        if is_blind and Signal.FORCE in moved:
            moved |= {Signal.GRIP}
        return moved

    def with_effect(self, effect: Effect) -> "Explanation":
        """Put an effect in, in the place of one of its name if there is."""
        names = [one.name for one in self.effects]
        if effect.name in names:
            at = names.index(effect.name)
            effects = (*self.effects[:at], effect, *self.effects[at + 1 :])
        else:
            effects = (*self.effects, effect)
        return replace(self, effects=effects)


def moves(effect: Effect) -> frozenset[Signal] | None:
    """Signals an effect changes; all for a sensor."""
    if effect.stage is Stage.SENSOR:
        return None
    stretches = acts_in_gripper(effect) and effect.hidden_contraction(1.0) != 0
    return frozenset({effect.signal, Signal.FORCE} if stretches else {effect.signal})
