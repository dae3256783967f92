"""A frame that yields: the length of a muscle that is held goes with its force.

A test stand gives way by some tenths of a millimetre, often less than its reading is
noisy. Over all held sweeps the force tells how far, and the pull of a muscle falls so
steeply with its contraction that it matters. It is no travel.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from gripperd.diagnose.noise.model import Noise
from gripperd.diagnose.noise.smoothing import Smooth
from gripperd.diagnose.readings.course import Course
from gripperd.model.track import Array

CERTAIN = 5.0
"""Standard errors by which contraction must go with the force: the drift of a sensor
may as well, by less. [-]"""
BORNE_OUT = 3.0
"""The same without any one sweep, in which it may be the way there. [-]"""
ARRIVED = 2.0
"""Time in which a carriage has come to the length that it holds: until then its way
there is no give. [s]"""
LOUD = 2.0
"""Variance about that from which it is no spring but a clearance, say, in units of the
noise: a reading so quiet is not mended by a straight line. [-]"""


def with_yielding_frame(courses: Sequence[Course], noise: Noise) -> list[Course]:
    """Let held sweeps go with their force, if all of them together do.

    Parameters
    ----------
    courses
        Of one recording.
    noise
        Of its contraction. [-]
    """
    held = [index for index, course in enumerate(courses) if _is_held(course)]
    pulls = [_about_mean(courses[index].level("force")) for index in held]
    pairs = [_there(courses[index]) for index in held]
    power = np.array([float(pull @ pull) for pull, _ in pairs])
    gone = np.array([float(pull @ np.nan_to_num(way)) for pull, way in pairs])
    others, left = (column.sum() - column for column in (gone, power))
    certain = gone.sum() > CERTAIN * (noise.slow_variance * power.sum()) ** 0.5
    if not certain or np.any(others <= BORNE_OUT * (noise.slow_variance * left) ** 0.5):
        return list(courses)
    compliance = float(gone.sum() / power.sum())
    rest = [way - compliance * pull for pull, way in pairs]
    if np.nanvar(np.concatenate(rest)) > LOUD * noise.std**2:
        return list(courses)
    found = [_filled(course, compliance) for course in courses]
    for index, pull in zip(held, pulls, strict=True):
        found[index] = _yielding(courses[index], compliance * pull, compliance)
    return found


def _there(course: Course) -> tuple[Array, Array]:
    """Pull and length about their means, once the length has been reached."""
    there = course.time - course.time[0] > ARRIVED
    if not there.any():
        return np.empty(0), np.empty(0)
    pull, way = course.level("force")[there], course.column("contraction")[there]
    return _about_mean(pull), _about_mean(way)


def _filled(course: Course, compliance: float) -> Course:
    """Let a muscle go with its force while it is filled, before it travels."""
    force, smooth = course.smooth.get("force"), dict(course.smooth)
    if force is None:
        return course
    for name in {"contraction", "length"} & smooth.keys():
        known = smooth[name]
        # Where nothing was seen to travel its level is one mean.
        before = np.logical_and.accumulate(known.value == known.value[0])
        way = np.zeros(len(course))
        way[before] = compliance * _about_mean(force.value[before])
        rate = np.where(before, compliance * force.rate, known.rate)
        if np.isfinite(way).all():
            smooth[name] = known._replace(value=known.value + way, rate=rate)
    return replace(course, smooth=smooth)


def _is_held(course: Course) -> bool:
    known = course.smooth.get("contraction"), course.smooth.get("force")
    return not course.direction.any() and all(
        one is not None and bool(np.isfinite(one.value).all()) for one in known
    )


def _about_mean(column: Array) -> Array:
    about: Array = column - np.nanmean(column)
    return about


def _yielding(course: Course, way: Array, compliance: float) -> Course:
    rate = compliance * course.rate("force")
    smooth = {
        name: _going(known, way, rate) if name in ("contraction", "length") else known
        for name, known in course.smooth.items()
    }
    return replace(course, smooth=smooth, yields=True)


def _going(known: Smooth, way: Array, rate: Array) -> Smooth:
    return known._replace(value=float(np.mean(known.value)) + way, rate=rate)
