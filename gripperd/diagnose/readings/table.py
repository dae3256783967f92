"""Whether a recording is a table: settled points, with a counter for a clock."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from gripperd.diagnose.readings.course import Course

LEAP = 0.02
"""Share of the range between neighbours from which points are no sweep. [-]"""


def lists_points(courses: Sequence[Course]) -> bool:
    """Tell whether all of its sweeps list points that were waited for.

    A counter counts on from one sweep to the next, or begins again. A logger that reads
    once a second goes on while the rig is set up.
    """
    first = courses[0].time[0]
    return all(_is_coarse(course) for course in courses) and all(
        later.time[0] in (first, earlier.time[-1] + 1)
        for earlier, later in pairwise(courses)
    )


def _is_coarse(course: Course) -> bool:
    pressure = course.level("pressure")
    far = np.median(np.abs(np.diff(pressure))) > LEAP * np.ptp(pressure)
    return bool(far) and bool(np.all(course.step[1:] == 1.0))
