"""What the supply has lost of its highest in a recording."""

from collections.abc import Sequence

import numpy as np

from gripperd.diagnose.readings.course import Course
from gripperd.model.track import Array


def supply_drops(courses: Sequence[Course]) -> list[Array]:
    """Give what it has lost in each sweep; 0 where nobody measured it. [Pa].

    A tank sinks from sweep to sweep more than within one, so that all are held against
    the highest of the recording.
    """
    levels = [course.level("supply") for course in courses]
    known = np.concatenate(levels)
    known = known[np.isfinite(known)]
    highest = float(known.max()) if known.size else 0.0
    return [np.nan_to_num(highest - level) for level in levels]
