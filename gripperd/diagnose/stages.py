"""What an explanation predicts, stage by stage, from measured inputs.

Each stage starts from what was measured before it, so an error upstream does not
smear: current to pressure; pressure and contraction to force; contraction to opening;
force and contraction to grip. A wrong sensor shows in every stage that touches it.
"""

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field, replace
from enum import StrEnum
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from gripperd.diagnose.course import Course
from gripperd.diagnose.travel import leaning, travel
from gripperd.model import Linkage, Muscle, Regulator
from gripperd.model.effect import (
    Effect,
    SensorEffect,
    Signal,
    Stage,
    acts_in_gripper,
    acts_in_sensor,
)
from gripperd.model.memory import begin, lag
from gripperd.model.track import Array, Track

Mask: TypeAlias = NDArray[np.bool_]

INPUTS: Mapping[Signal, tuple[str, ...]] = {
    Signal.PRESSURE: ("current", "pressure"),
    Signal.FORCE: ("pressure", "contraction", "force"),
    Signal.OPENING: ("contraction", "opening"),
    Signal.GRIP: ("contraction", "grip"),
}
"""Columns a stage needs, with the one it predicts."""

STRETCHED = 4e-4
"""Contraction inside a mount that counts as travel: no noise moves it. [-]"""


class AtRest(StrEnum):
    """Sign of dry friction in a sweep without travel: the model leaves it open."""

    CARRIED = "carried"
    """As the rig came there: unknown, but the same throughout the sweep."""
    INFLATING = "inflating"
    """It turns with the pressure."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Explanation:
    """A model, its constants, and the effects thought to act."""

    muscle: Muscle
    regulator: Regulator | None
    linkage: Linkage | None
    effects: tuple[Effect, ...]
    at_rest: AtRest = AtRest.CARRIED
    zeros: Mapping[Signal, float] = field(default_factory=dict)
    """Small zero errors of sensors, within what any sensor has. [SI]"""
    rests: Mapping[int, float] = field(default_factory=dict)
    """Sign of friction in sweeps without travel, by index of the course. [-1..1]"""
    skews: Mapping[Signal, float] = field(default_factory=dict)
    """How much earlier than the force a channel is sampled. [s]"""
    response: float = 0.0
    """Lag that any regulator has. [s]"""
    told_length: float | None = None
    """Rest length to which the recorded contraction refers, when another. [m]"""

    def sensors(self) -> "tuple[SensorEffect, ...]":
        """Effects that change what is read."""
        return tuple(effect for effect in self.effects if acts_in_sensor(effect))

    def with_effect(self, effect: Effect) -> "Explanation":
        """Put an effect in, in the place of one of its name if there is."""
        names = [one.name for one in self.effects]
        if effect.name in names:
            at = names.index(effect.name)
            effects = (*self.effects[:at], effect, *self.effects[at + 1 :])
        else:
            effects = (*self.effects, effect)
        return replace(self, effects=effects)


def predictable(course: Course) -> tuple[Signal, ...]:
    """Signals of which a sweep has the measurement and what it follows from."""
    return tuple(
        signal
        for signal, columns in INPUTS.items()
        if all(np.isfinite(course.column(name)).any() for name in columns)
    )


def predicted(
    explanation: Explanation,
    course: Course,
    signals: Collection[Signal],
    track: Track,
) -> dict[Signal, Array]:
    """Readings the explanation expects. [SI].

    Parameters
    ----------
    explanation
        What is thought to act.
    course
        The sweep.
    signals
        Those wanted, of :func:`predictable`.
    track
        What :func:`track_of` gives for them.
    """
    return {
        signal: _read(explanation, signal, _happened(explanation, signal, track), track)
        for signal in signals
    }


def _happened(explanation: Explanation, signal: Signal, track: Track) -> Array:
    """What the chain does. [SI]."""
    if signal is Signal.FORCE:
        track = _strained(explanation, track)
    if signal is Signal.GRIP:
        track = replace(track, direction=leaning(track.force))
    value = _START[signal](explanation, track)
    for effect in explanation.effects:
        if effect.signal is signal and effect.stage is not Stage.SENSOR:
            value = effect.along(value, track, effect.rest())
    if signal is Signal.PRESSURE and explanation.response > 0:
        quick = explanation.response
        value = lag(value, track.step, quick, quick, begin())
    # Neither does a regulator suck, nor do jaws pull at what they hold.
    bounded = signal in (Signal.PRESSURE, Signal.GRIP)
    return np.maximum(value, 0.0) if bounded else value


def _strained(explanation: Explanation, track: Track) -> Track:
    """The muscle inside a mount that stretches is shorter than measured."""
    pull = np.fmax(track.force, 0.0)
    hidden = [
        effect.hidden_contraction(pull)
        for effect in explanation.effects
        if acts_in_gripper(effect)
    ]
    if not any(np.any(one) for one in hidden):
        return track
    contraction = np.asarray(track.contraction + sum(hidden))
    turning = travel(contraction, STRETCHED)
    direction = np.where(turning == 0, track.direction, turning)
    return replace(track, contraction=contraction, direction=direction)


def _read(
    explanation: Explanation, signal: Signal, value: Array, track: Track
) -> Array:
    """What the sensors say of it. [SI]."""
    for sensor in explanation.sensors():
        if sensor.signal is signal:
            value = sensor.along(value, track, sensor.rest())
    skew = explanation.skews.get(signal, 0.0)
    if skew and signal in (Signal.OPENING, Signal.GRIP):
        value = value - skew * np.gradient(value, track.time)
    return value + explanation.zeros.get(signal, 0.0)


def _pressure(explanation: Explanation, track: Track) -> Array:
    return track.command


def _force(explanation: Explanation, track: Track) -> Array:
    return track.pressure * track.pull_area


def _opening(explanation: Explanation, track: Track) -> Array:
    linkage, length = explanation.linkage, explanation.muscle.rest_length
    if linkage is None:
        return np.full_like(track.time, np.nan)
    return np.asarray(linkage.opening(track.contraction, length))


def _grip(explanation: Explanation, track: Track) -> Array:
    linkage, length = explanation.linkage, explanation.muscle.rest_length
    if linkage is None:
        return np.full_like(track.time, np.nan)
    return np.asarray(linkage.grip_force(track.force, track.contraction, length))


def passed_on(
    explanation: Explanation, course: Course, track: Track, signal: Signal
) -> Array | float:
    """What smooth inputs leave out of a prediction: noise, and sharp corners.

    It belongs to the residual as the noise it is. Left inside the prediction, any
    effect that filters its input would seem to explain it.
    """
    if signal is Signal.PRESSURE:
        return 0.0
    length = "length" if "length" in course.smooth else "contraction"
    sharp = replace(track, contraction=course.level(length))
    rough = [_START[signal](explanation, one) for one in (sharp, track)]
    for effect in explanation.effects:
        if effect.signal is signal and not effect.rest().size:
            rough = [
                effect.along(value, one, effect.rest())
                for value, one in zip(rough, (sharp, track), strict=True)
            ]
    return np.nan_to_num(rough[0] - rough[1])


_START: Mapping[Signal, Callable[[Explanation, Track], Array]] = {
    Signal.PRESSURE: _pressure,
    Signal.FORCE: _force,
    Signal.OPENING: _opening,
    Signal.GRIP: _grip,
}


def track_of(explanation: Explanation, course: Course, index: int) -> Track:
    """What happened, as the explanation has it: sensor errors undone."""
    regulator = explanation.regulator
    span = (
        (regulator.pressure_low, regulator.pressure_high) if regulator else (0.0, 1.0)
    )
    command = np.full_like(course.time, np.nan)
    zeros = explanation.zeros
    if regulator is not None:
        span = (regulator.pressure_low, regulator.pressure_high)
        command = np.clip(regulator.pressure(course.column("current")), *span)
    rough = Track(
        muscle=explanation.muscle,
        time=course.time,
        step=course.step,
        command=command,
        span=span,
        still=course.still,
        pressure=_pressure_at(explanation, course),
        contraction=_contraction(explanation, course),
        rate=_rate(course),
        direction=directions(explanation, course, index),
        force=course.level("force") - zeros.get(Signal.FORCE, 0.0),
        grip=course.level("grip"),
        temperature=course.level("temperature"),
        supply=course.column("supply"),
        ambient=course.column("ambient"),
        cycle=course.cycle,
        repeat=course.repeat,
    )
    sensors = explanation.sensors()
    if not sensors:
        return rough
    readings = {
        Signal.PRESSURE: rough.pressure,
        Signal.CONTRACTION: rough.contraction,
        Signal.FORCE: rough.force,
        Signal.GRIP: rough.grip,
    }
    for sensor in reversed(sensors):
        if sensor.signal in readings:
            readings[sensor.signal] = sensor.truth(readings[sensor.signal], rough)
    return replace(
        rough,
        pressure=readings[Signal.PRESSURE],
        contraction=readings[Signal.CONTRACTION],
        force=readings[Signal.FORCE],
        grip=readings[Signal.GRIP],
    )


def _rate(course: Course) -> Array:
    known = course.smooth.get("contraction")
    return known.rate if known else np.zeros_like(course.time)


def _pressure_at(explanation: Explanation, course: Course) -> Array:
    """Pressure at the time of the force sample. [Pa]."""
    read = course.level("pressure") - explanation.zeros.get(Signal.PRESSURE, 0.0)
    skew = explanation.skews.get(Signal.PRESSURE, 0.0)
    if skew and "pressure" in course.smooth:
        read = read - skew * course.smooth["pressure"].rate
    return read


def _contraction(explanation: Explanation, course: Course) -> Array:
    """Contraction that refers to the rest length of the explanation. [-]."""
    read = course.level("contraction")
    read = read - explanation.zeros.get(Signal.CONTRACTION, 0.0)
    read = read - explanation.skews.get(Signal.CONTRACTION, 0.0) * _rate(course)
    if explanation.told_length is None:
        return read
    return 1 - (1 - read) * explanation.told_length / explanation.muscle.rest_length


def directions(explanation: Explanation, course: Course, index: int) -> Array:
    """Direction of travel; before there was any, what is assumed of it. [-1..1]."""
    sign = explanation.rests.get(index, 1.0)
    pressure = course.level("pressure")
    inflating = explanation.at_rest is AtRest.INFLATING
    if inflating and not course.direction.any() and np.isfinite(pressure).all():
        turning = travel(pressure, max(0.02 * float(np.ptp(pressure)), 3e3))
        return np.where(turning == 0, sign, turning)
    return np.where(course.direction == 0, sign, course.direction)
