"""Jaws that clamp under a steady load: which way their joints rub is not known.

It is as they came there, before the record. Where the load of other sweeps turns their
joints round, those tell of friction, and a hold would only contradict them.
"""

from collections.abc import Sequence

import numpy as np

from gripperd.diagnose.readings.course import Course
from gripperd.diagnose.readings.grasp import PRESSED
from gripperd.diagnose.readings.travel import LOOSE, leaning


def clamped(courses: Sequence[Course]) -> list[bool]:
    """Which sweeps hold an object by joints that never come loose, if others do.

    Parameters
    ----------
    courses
        All sweeps of a recording.
    """
    loose = [_comes_loose(course) for course in courses]
    return [any(loose) and one is False for one in loose]


def _comes_loose(course: Course) -> bool | None:
    """Whether joints come loose while jaws press; none where they press on nothing."""
    pressed = course.column("grip") > PRESSED * course.hush("grip")
    load = course.level("pressure" if course.is_blind else "force")
    if not pressed.any() or not np.isfinite(load).all():
        return None
    return bool(np.any(np.abs(leaning(load)[pressed]) > LOOSE))
