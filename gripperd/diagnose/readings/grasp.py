"""Jaws that hold an object: what bends seems to travel, and tells no friction its way.

A muscle whose grip grows contracts, or is held. Where nothing but the opening tells its
length, and that grows as well, it is the jaws that give.
"""

from dataclasses import replace
from itertools import pairwise

import numpy as np

from gripperd.diagnose.noise.model import Noise
from gripperd.diagnose.readings.course import Course
from gripperd.model.track import Array

PRESSED = 5.0
"""Standard deviations of its noise from which a grip is one. [-]"""
MOSTLY = 0.5
"""Share of a way that is under a grip, from which jaws may go it as they bend. [-]"""
CLOSELY = 0.7
"""Correlation of that with the grip, against it, from which they do. [-]"""
SURE = 2.0
"""Standard deviations of a contraction that they seem to go by at least. [-]"""


def with_held_way(course: Course, noise: Noise) -> Course:
    """Let friction keep the sign with which jaws came that bend about an object.

    Parameters
    ----------
    course
        Whose contraction is told by its opening.
    noise
        Of its grip. [N]
    """
    if "contraction" not in course.smooth:
        return course
    known, grip = course.smooth["contraction"], course.level("grip")
    pressed = np.isfinite(grip) & (grip > PRESSED * noise.std)
    direction, bends = course.direction.copy(), False
    turns = np.flatnonzero(np.diff(direction)) + 1
    for start, end in pairwise([*turns, len(course)]):
        held = start + np.flatnonzero(pressed[start:end])
        if held.size < MOSTLY * (end - start) or np.ptp(grip[held]) == 0:
            continue
        if _bends(known.value[held], grip[held], SURE * known.spread):
            direction[start:end], bends = direction[start - 1], True
    return replace(course, direction=direction, bends=bends)


def _bends(way: Array, grip: Array, least: float) -> bool:
    """Whether jaws seem to open while their grip grows, or to close while it falls."""
    return bool(np.ptp(way) > least and np.corrcoef(way, grip)[0, 1] < -CLOSELY)
