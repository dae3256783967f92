"""The course of one run: what was measured, and the same without noise."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gripperd.diagnose.recording import Kind
from gripperd.diagnose.smoothing import Smooth
from gripperd.diagnose.travel import travel
from gripperd.model.track import Array

LEAP = 0.02
"""Share of the range between neighbours from which points are no sweep. [-]"""

TURNED, LEAST_TURNED = 0.02, 3e3
"""Pressure that must be undone before it counts as reversed: share of its range, and
at least. [-, Pa]"""


@dataclass(frozen=True)
class Course:
    """One sweep without a pause; arrays of shape ``(n,)`` in SI, NaN not measured."""

    run: str
    kind: Kind | None
    time: Array
    step: Array
    measured: Mapping[str, Array]
    smooth: Mapping[str, Smooth]
    """Columns without noise; ``length`` is the contraction with its corners sharp."""
    cycle: Array
    repeat: Array
    direction: Array
    """Direction of travel, 0 before there was any. [-]"""
    still: Array
    """Time since the command last moved. [s]"""

    def __len__(self) -> int:
        """Number of samples."""
        return self.time.size

    def column(self, name: str) -> Array:
        """Measured column, NaN when there is none."""
        if name in self.measured:
            return self.measured[name]
        return np.full_like(self.time, np.nan)

    def level(self, name: str) -> Array:
        """Column without its noise where that was taken off."""
        return self.smooth[name].value if name in self.smooth else self.column(name)

    @cached_property
    def inflating(self) -> Array:
        """Direction of the pressure, 0 before it moved and when not known. [-]."""
        pressure = self.level("pressure")
        if not np.isfinite(pressure).all():
            return np.zeros_like(pressure)
        return travel(pressure, max(TURNED * float(np.ptp(pressure)), LEAST_TURNED))


def is_table(sweeps: Sequence[Course]) -> bool:
    """Tell whether a recording lists settled points, with a counter for a clock."""
    return all(
        np.all(course.step[1:] == 1.0)
        and np.median(np.abs(np.diff(course.level("pressure"))))
        > LEAP * np.ptp(course.level("pressure"))
        for course in sweeps
    )
