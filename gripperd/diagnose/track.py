"""What happened in a sweep, as an explanation has it."""

from dataclasses import replace

import numpy as np

from gripperd.diagnose.course import Course
from gripperd.diagnose.explanation import AtRest, Explanation
from gripperd.model.effect import Signal
from gripperd.model.track import Array, Track


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
    inflating = explanation.at_rest is AtRest.INFLATING
    still = inflating and not course.direction.any()
    known = course.inflating if still else course.direction
    return np.where(known == 0, sign, known)
