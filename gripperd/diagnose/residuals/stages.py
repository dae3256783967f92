"""What an explanation predicts, stage by stage, from measured inputs.

Each stage starts from what was measured before it, so an error upstream does not
smear: current to pressure; pressure and contraction to force; contraction to opening;
force and contraction to grip. A wrong sensor shows in every stage that touches it.
Without a cell in the muscle the grip shows what it pulls with as well: from pressure
and contraction to grip is one step.
"""

from collections.abc import Callable, Collection, Mapping
from dataclasses import replace
from functools import partial

import numpy as np

from gripperd.diagnose.readings.course import Course
from gripperd.diagnose.readings.fault import Mask
from gripperd.diagnose.readings.travel import leaning
from gripperd.diagnose.residuals.explanation import Explanation
from gripperd.diagnose.residuals.runs import Runs
from gripperd.model.effect import Effect, Signal, Stage, acts_in_gripper
from gripperd.model.memory import begin, stop, trail
from gripperd.model.track import Array, Track

INPUTS: Mapping[Signal, tuple[str, ...]] = {
    Signal.PRESSURE: ("current", "pressure"),
    Signal.FORCE: ("pressure", "contraction", "force"),
    Signal.OPENING: ("contraction", "opening"),
    Signal.GRIP: ("contraction", "grip"),
}
"""Columns a stage needs, with the one it predicts."""
DRIVEN = 0.02
"""Contraction over which a machine moves jaws, at least. [-]"""
OPPOSED = 0.95
"""Share of the way on which the load falls as they close, or rises as they open: where
a machine moves them 0.99; on objects, whose jaws but seem to move, up to 0.8. [-]"""
HELD = 0.05
"""Share of its height by which a pressure changes under a machine, at most: a regulator
holds it. [-]"""
BRAIDED = "braid_friction"
"""What rubs between the bladder and its braid."""
TURNED = 4e-4
"""Half the way back, of a muscle inside a mount, over which its friction turns. [-]"""


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
    track: Runs,
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


def _happened(explanation: Explanation, signal: Signal, track: Runs) -> Array:
    """What the chain does. [SI]."""
    if signal is Signal.FORCE:
        track = _strained(explanation, track)
    if signal is Signal.OPENING:
        track = _pulled(track, partial(_held_by, explanation), rounds=1)
    if signal is Signal.GRIP:
        made = partial(_happened, explanation, Signal.FORCE)
        track = _leaned(explanation, _pulled(track, made, _rounds(explanation)))
    value = _START[signal](explanation, track)
    for effect in explanation.effects:
        if effect.signal is signal and effect.stage is not Stage.SENSOR:
            value = _along(effect, value, track)
    if signal is Signal.PRESSURE and explanation.response > 0:
        quick = explanation.response
        value = track.each(
            lambda one, run: trail(one, run.step, quick, begin(2)), value
        )
    # Neither does a regulator suck, nor do jaws pull at what they hold.
    bounded = signal in (Signal.PRESSURE, Signal.GRIP)
    return np.maximum(value, 0.0) if bounded else value


def _pulled(track: Runs, pull: Callable[[Runs], Array], rounds: int) -> Runs:
    """Fill in the pull of runs that no cell tells, with what the muscle makes of it."""
    if not np.isnan(track.force).any():
        return track
    untold = track.each(
        lambda force, _: np.full_like(force, np.isnan(force).all()), track.force
    ).astype(bool)
    for _ in range(rounds if untold.any() else 0):
        track = replace(track, force=np.where(untold, pull(track), track.force))
    return track


def _held_by(explanation: Explanation, track: Runs) -> Array:
    """Pull that grip and return spring take up. [N]."""
    linkage, length = explanation.linkage, explanation.muscle.rest_length
    if linkage is None:
        return track.force
    return np.asarray(linkage.muscle_force(track.grip, track.contraction, length))


def _rounds(explanation: Explanation) -> int:
    """Times that a pull is looked at: a mount stretches by what it had before."""
    return 2 if any(map(acts_in_gripper, explanation.effects)) else 1


def _leaned(explanation: Explanation, track: Runs) -> Runs:
    """The way joints rub: that of their load, unless they keep that of the travel."""
    if not any(acts_in_gripper(one) and one.leans for one in explanation.effects):
        return track
    return replace(track, direction=track.each(_rubbing, track.force))


def _rubbing(load: Array, run: Track) -> Array:
    """Joints rub the way their load goes: jaws on an object hardly travel.

    But where a machine moves them against a pressure that is held, the load falls as
    they close, and rises as they open: there they rub the way they go.
    """
    held = _held(run)
    work = np.diff(load) * np.diff(run.contraction)
    work = np.nan_to_num(work)[held[1:] & held[:-1]]
    falls = -work.sum() > OPPOSED * np.abs(work).sum()
    driven = falls and np.ptp(run.contraction[held]) > DRIVEN
    return np.where(held & driven, run.direction, leaning(load))


def _held(run: Track) -> Mask:
    """Samples near the pressure at which half of the way of a run is gone."""
    way = np.abs(np.diff(run.contraction, prepend=run.contraction[:1]))
    order = np.argsort(run.pressure)
    gone = np.cumsum(np.nan_to_num(way)[order])
    level = run.pressure[order[np.searchsorted(gone, gone[-1] / 2)]]
    within = HELD / 2 * np.max(np.abs(run.pressure))
    return np.asarray(np.abs(run.pressure - level) < within)


def _strained(explanation: Explanation, track: Runs) -> Runs:
    """The muscle inside a mount that stretches is shorter than measured."""
    pull = np.fmax(track.force, 0.0)
    hidden = [
        effect.hidden_contraction(pull)
        for effect in explanation.effects
        if acts_in_gripper(effect)
    ]
    if not any(np.any(one) for one in hidden):
        return track
    stretch = np.asarray(sum(hidden))
    contraction = track.contraction + stretch
    rate = track.rate + track.slope(stretch)
    turned = track.each(_turned, contraction) - track.each(_turned, track.contraction)
    direction = sliding = np.clip(track.direction + turned, -1.0, 1.0)
    if track.sliding is not track.direction:
        sliding = np.clip(track.sliding + turned, -1.0, 1.0)
    return replace(
        track, contraction=contraction, rate=rate, direction=direction, sliding=sliding
    )


def _turned(contraction: Array, run: Track) -> Array:
    """Sign of friction that turns with the way gone, and so with the stretch."""
    start = contraction[:1] - TURNED * run.direction[:1]
    return stop(contraction, TURNED, start) / TURNED


def _along(effect: Effect, value: Array, track: Runs) -> Array:
    """Signal with an effect; one that remembers begins anew in each run."""
    if effect.name == BRAIDED and track.sliding is not track.direction:
        track = track.of_bladder
    if not effect.rest().size:
        return effect.along(value, track, effect.rest())
    return track.each(lambda one, run: effect.along(one, run, effect.rest()), value)


def _read(explanation: Explanation, signal: Signal, value: Array, track: Runs) -> Array:
    """What the sensors say of it. [SI]."""
    for sensor in explanation.sensors():
        if sensor.signal is signal:
            value = _along(sensor, value, track)
    skew = explanation.skews.get(signal, 0.0)
    if skew and signal in (Signal.OPENING, Signal.GRIP):
        value = value - skew * track.slope(value - _rough(explanation, signal, track))
    return value + explanation.zeros.get(signal, 0.0)


def _rough(explanation: Explanation, signal: Signal, track: Runs) -> Array | float:
    """What the noise of a late cell makes of a grip: between two readings is less."""
    if signal is not Signal.GRIP or not track.beside.any():
        return 0.0
    smooth = replace(track, beside=np.zeros_like(track.beside))
    return _grip(explanation, track) - _grip(explanation, smooth)


def _pressure(explanation: Explanation, track: Runs) -> Array:
    return track.command


def _force(explanation: Explanation, track: Runs) -> Array:
    return track.pressure * track.pull_area


def _opening(explanation: Explanation, track: Runs) -> Array:
    linkage, length = explanation.linkage, explanation.muscle.rest_length
    if linkage is None:
        return np.full_like(track.time, np.nan)
    return np.asarray(linkage.opening(track.contraction, length))


def _grip(explanation: Explanation, track: Runs) -> Array:
    linkage, length = explanation.linkage, explanation.muscle.rest_length
    if linkage is None:
        return np.full_like(track.time, np.nan)
    force = track.force + track.beside
    return np.asarray(linkage.grip_force(force, track.contraction, length))


_START: Mapping[Signal, Callable[[Explanation, Runs], Array]] = {
    Signal.PRESSURE: _pressure,
    Signal.FORCE: _force,
    Signal.OPENING: _opening,
    Signal.GRIP: _grip,
}


def passed_on(
    explanation: Explanation, course: Course, track: Runs, signal: Signal
) -> Array | float:
    """What smooth inputs leave out of a prediction: noise, and sharp corners.

    It belongs to the residual as the noise it is. Left inside the prediction, any
    effect that filters its input would seem to explain it. An opening is compared with
    the contraction reading by reading: a trend is quieter the slower the jaws go, and
    no noise would fit them all. So is a grip with the force: a smooth force lags where
    jaws meet and leave an object, as friction in the joints does, and its noise would
    be as slow as an effect.
    """
    if signal is Signal.PRESSURE:
        return 0.0
    length = "length" if "length" in course.smooth else "contraction"
    sharp = replace(track, contraction=course.level(length))
    if signal is Signal.OPENING:
        column = course.column("contraction")
        read = np.where(np.isfinite(column), column, sharp.contraction)
        sharp = replace(track, contraction=read)
    if signal is Signal.GRIP:
        beside = course.column("force") - course.level("force")
        sharp = replace(sharp, force=track.force + beside)
        sharp, track = (_felt(explanation, one) for one in (sharp, track))
        track = _leaned(explanation, track)
        sharp = replace(sharp, direction=track.direction)
    rough, smooth = (at_once(explanation, one, signal) for one in (sharp, track))
    return np.nan_to_num(rough - smooth)


def _felt(explanation: Explanation, track: Runs) -> Runs:
    """Give a pull that no cell tells as it follows without memory."""
    rounds = _rounds(explanation)
    return _pulled(track, lambda one: at_once(explanation, one, Signal.FORCE), rounds)


def at_once(explanation: Explanation, track: Runs, signal: Signal) -> Array:
    """What follows without memory, as a signal that may be rough is passed on. [SI].

    Parameters
    ----------
    explanation
        What is thought to act.
    track
        What happened.
    signal
        That which is made.
    """
    value = _START[signal](explanation, track)
    for effect in explanation.effects:
        if effect.signal is signal and not effect.rest().size:
            value = effect.along(value, track, effect.rest())
    return value
