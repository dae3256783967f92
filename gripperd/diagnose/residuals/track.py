"""What happened in a sweep, as an explanation has it."""

from collections.abc import Callable, Hashable
from dataclasses import replace
from functools import partial
from types import MappingProxyType
from weakref import WeakKeyDictionary

import numpy as np

from gripperd.diagnose.readings.course import Course
from gripperd.diagnose.residuals.explanation import AtRest, Explanation
from gripperd.diagnose.residuals.runs import Runs
from gripperd.model.effect import SensorEffect, Signal, acts_in_gripper
from gripperd.model.loaded import LoadedLinkage
from gripperd.model.memory import stop
from gripperd.model.track import Array

TURNED = MappingProxyType({AtRest.INFLATING: 0.01, AtRest.YIELDING: 0.025})
"""Half the way back of a pressure that turns friction round where nothing travels, as a
share of its range: the latter is near one that nears its sign by e in each 2 %. [-]"""
AWAKE = 5e3
"""Pressure over which a regulator comes to its line that vents below it. [Pa]"""
LEAST_TURNED = 3e3
"""The same, at least. [Pa]"""

_KNOWN: WeakKeyDictionary[Course, dict[Hashable, tuple[Hashable, Array]]] = (
    WeakKeyDictionary()
)
"""What was told of sweeps, by what it is, and what it was told from."""


def track_of(explanation: Explanation, course: Course, *places: int) -> Runs:
    """What happened, as the explanation has it: sensor errors undone.

    Parameters
    ----------
    explanation
        What is thought to act.
    course
        A sweep, or several end to end.
    places
        Of each of them in the recording.
    """
    regulator = explanation.regulator
    span = (
        (regulator.pressure_low, regulator.pressure_high) if regulator else (0.0, 1.0)
    )
    zeros = explanation.zeros
    direction = sliding = directions(explanation, course, *places)
    if explanation.at_rest is AtRest.BLADDER:
        inflating = replace(explanation, at_rest=AtRest.INFLATING)
        sliding = directions(inflating, course, *places)
    rough = Runs(
        muscle=explanation.muscle,
        time=_told(course, "time", (), lambda: course.time - course.start),
        step=course.step,
        command=_command(explanation, course),
        span=span,
        still=course.still,
        waiting=course.waiting,
        pressure=_pressure_at(explanation, course),
        contraction=_contraction(explanation, course),
        rate=course.rate("contraction"),
        direction=direction,
        sliding=sliding,
        came=_came(explanation, course, *places),
        force=course.level("force") - zeros.get(Signal.FORCE, 0.0),
        grip=course.level("grip"),
        temperature=course.level("temperature"),
        supply_drop=course.supply_drop,
        ambient=course.level("ambient"),
        cycle=course.cycle,
        repeat=course.repeat,
        slices=course.slices,
        beside=np.zeros_like(course.time),
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
    beside = rest = _told(course, "rest", (), lambda: _of_nearest(course))
    for sensor in reversed(sensors):
        if sensor.signal is Signal.FORCE:
            beside = _rest(sensor, beside, rough)
        if sensor.signal in readings:
            readings[sensor.signal] = _truth(sensor, readings[sensor.signal], rough)
    return replace(
        rough,
        pressure=readings[Signal.PRESSURE],
        contraction=readings[Signal.CONTRACTION],
        force=readings[Signal.FORCE],
        grip=readings[Signal.GRIP],
        beside=beside - rest,
    )


def _truth(sensor: SensorEffect, reading: Array, track: Runs) -> Array:
    if not sensor.rest().size:
        return sensor.truth(reading, track)
    return track.each(sensor.truth, reading)


def _rest(sensor: SensorEffect, rest: Array, track: Runs) -> Array:
    """What a smooth reading leaves out, when a sensor's lateness is undone.

    It is that of the nearest sample: a way between two would have less noise than
    either, and so any delay would seem to explain some. So would any gain that shrinks
    it, and it stays as it was read.
    """
    if not sensor.rest().size:
        return rest
    places = track.each(sensor.truth, np.arange(float(rest.size)))
    return np.asarray(rest[np.rint(places).astype(int)])


def _of_nearest(course: Course) -> Array:
    """What a smooth force leaves out, of samples not read that of the nearest. [N].

    It is 0 if none was read. A slow channel has such samples between others. Without
    noise there, a delay that reaches them would seem to explain what it only silences.
    """
    rest = course.column("force") - course.level("force")
    read = np.flatnonzero(np.isfinite(rest))
    if not read.size:
        return np.zeros_like(rest)
    between = (read[1:] + read[:-1]) / 2
    nearest: Array = rest[read[np.searchsorted(between, np.arange(rest.size))]]
    return nearest


def _told(
    course: Course, what: Hashable, given: Hashable, tell: Callable[[], Array]
) -> Array:
    """Give what a sweep tells, not to be written to, anew if what is given differs.

    A fit moves one constant after the other, and most of them change little here.
    """
    known = _KNOWN.setdefault(course, {})
    last = known.get(what)
    if last is None or last[0] != given:
        last = given, tell()
        last[1].flags.writeable = False
        known[what] = last
    return last[1]


def _command(explanation: Explanation, course: Course) -> Array:
    """Pressure that a textbook regulator gives for the current. [Pa]."""
    regulator, vents = explanation.regulator, explanation.vents
    if regulator is None:
        return np.full_like(course.time, np.nan)
    low, high = regulator.pressure_low, regulator.pressure_high

    def tell() -> Array:
        command = np.clip(regulator.pressure(course.column("current")), low, high)
        if vents is not None:
            command -= (low - vents) * np.exp((low - command) / AWAKE)
        return np.asarray(command)

    return _told(course, "command", (regulator, vents), tell)


def _pressure_at(explanation: Explanation, course: Course) -> Array:
    """Pressure at the time of the force sample. [Pa]."""
    zero = explanation.zeros.get(Signal.PRESSURE, 0.0)
    skew = explanation.skews.get(Signal.PRESSURE, 0.0)

    def tell() -> Array:
        read = course.level("pressure") - zero
        return read - skew * course.rate("pressure") if skew else read

    return _told(course, "pressure", (zero, skew), tell)


def _contraction(explanation: Explanation, course: Course) -> Array:
    """Contraction that refers to the rest length of the explanation. [-]."""
    zero = explanation.zeros.get(Signal.CONTRACTION, 0.0)
    skew = explanation.skews.get(Signal.CONTRACTION, 0.0)

    def tell() -> Array:
        read = course.level("contraction") - zero
        return read - skew * course.rate("contraction")

    read = _told(course, "contraction", (zero, skew), tell)
    if explanation.told_length is None:
        return read
    if explanation.told_by is not None:
        opening = explanation.told_by.opening(read, explanation.told_length)
        return _of_opening(explanation, course, np.asarray(opening))
    return 1 - (1 - read) * explanation.told_length / explanation.muscle.rest_length


def _of_opening(explanation: Explanation, course: Course, opening: Array) -> Array:
    """Contraction at which the jaws are so far apart. [-]."""
    assert explanation.linkage is not None
    effects = tuple(filter(acts_in_gripper, explanation.effects))
    grip = np.nan_to_num(course.level("grip"))
    length = explanation.muscle.rest_length
    loaded = LoadedLinkage(explanation.linkage, effects)
    return np.asarray(loaded.contraction(opening, grip, course.direction, length))


def directions(explanation: Explanation, course: Course, *places: int) -> Array:
    """Direction of travel; before there was any, the sign of what it is held by."""
    signs = tuple(explanation.rests.get(place, 1.0) for place in places)
    given = explanation.winding, explanation.fading, explanation.stiction, *signs
    tell = partial(_directions, explanation, course, *places)
    return _told(course, explanation.at_rest, given, tell)


def _directions(explanation: Explanation, course: Course, *places: int) -> Array:
    found = course.direction.copy()
    share = TURNED.get(explanation.at_rest, 0.0)
    for piece, place in zip(course.slices, places, strict=True):
        sign, known = explanation.rests.get(place, 1.0), found[piece]
        pressure = course.level("pressure")[piece]
        if known.any() or not (share and np.isfinite(pressure).all()):
            known[known == 0] = sign * (1 + explanation.stiction)
            continue
        if course.yields and explanation.winding:
            way, radius = course.level("contraction")[piece], explanation.winding
        else:
            way, radius = pressure, turning(pressure, share)
        turned = stop(way, radius, way[:1] - sign * radius) / radius
        found[piece] = turned * (1 + explanation.stiction)
    for halt in course.halts if share else ():
        found[halt] = _halting(course.level("pressure")[halt], found[halt], share)
    if explanation.fading:
        rested = course.stood if share else course.rested
        found *= np.exp(-rested / explanation.fading)
    return found


def _halting(pressure: Array, came: Array, share: float) -> Array:
    """Sign in a halt: as it came there, and from there on that of the pressure.

    Until it travels the other way.
    """
    radius = turning(pressure, share)
    turned = stop(pressure, radius, pressure[:1] - came[0] * radius) / radius
    return np.where(came == came[0], turned, came)


def _came(explanation: Explanation, course: Course, *places: int) -> Array:
    """Sign with which sweeps rest that have no travel; not known of the others."""
    signs = tuple(explanation.rests.get(place) for place in places)

    def tell() -> Array:
        found = np.full_like(course.time, np.nan)
        for piece, sign in zip(course.slices, signs, strict=True):
            if sign is not None and not course.direction[piece].any():
                found[piece] = sign
        return found

    return _told(course, "came", signs, tell)


def turning(pressure: Array, share: float) -> float:
    """Half the way back that turns friction round where nothing travels. [Pa]."""
    return max(share * float(np.ptp(pressure)), LEAST_TURNED)
