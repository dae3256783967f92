"""The course of a run: what was measured, and the same without noise."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gripperd.diagnose.noise.smoothing import Smooth
from gripperd.diagnose.readings.recording import Kind
from gripperd.model.track import Array


@dataclass(frozen=True, eq=False)
class Course:
    """A sweep without a pause, or several end to end; each is itself alone.

    Arrays of shape ``(n,)`` in SI, NaN not measured.
    """

    run: str
    kind: Kind | None
    time: Array
    step: Array
    measured: Mapping[str, Array]
    smooth: Mapping[str, Smooth]
    """Columns without noise; ``length`` is the contraction with its corners sharp."""
    cycle: Array
    repeat: Array
    supply_drop: Array
    """What the supply has lost of its highest; 0 where that is not measured. [Pa]"""
    direction: Array
    """Direction of travel, 0 before there was any. [-]"""
    still: Array
    """Time since the command last moved. [s]"""
    waiting: Array
    """The same, 0 where a regulator is taken to keep the pressure. [s]"""
    rested: Array
    """Time since it came to rest where a machine holds it, 0 anywhere else. [s]"""
    stood: Array
    """The same, since its pressure stands as well. [s]"""
    on_stairs: bool = False
    """Whether the pressure of its recording goes in stairs, which no trend follows."""
    yields: bool = False
    """Whether it is held by a frame that yields."""
    bends: bool = False
    """Whether jaws that tell its contraction bend about an object."""
    clamped: bool = False
    """Whether jaws hold an object by joints that never come loose, and others do."""
    listed: bool = False
    """Whether its recording lists settled points, with a counter for a clock."""
    halts: tuple[slice, ...] = ()
    """Stretches in which it is held amid its travel, while its pressure goes on."""
    slices: tuple[slice, ...] = (slice(None),)
    """Samples of each sweep."""
    start: float = 0.0
    """When the recording began. [s]"""

    def __len__(self) -> int:
        """Number of samples."""
        return self.time.size

    @cached_property
    def is_blind(self) -> bool:
        """Whether no cell told what the muscle pulled with, but the jaws a grip."""
        grip, force = (np.isfinite(self.column(one)) for one in ("grip", "force"))
        return bool(grip.any() and not force.any())

    def column(self, name: str) -> Array:
        """Measured column, NaN when there is none."""
        if name in self.measured:
            return self.measured[name]
        return np.full_like(self.time, np.nan)

    def level(self, name: str) -> Array:
        """Column without its noise where that was taken off."""
        return self.smooth[name].value if name in self.smooth else self.column(name)

    def hush(self, name: str) -> float:
        """One sigma of the noise taken off a column, as a mean of many has it."""
        return self.smooth[name].variance ** 0.5 if name in self.smooth else 0.0

    def doubt(self, name: str) -> Array | float:
        """One sigma of the level of a column; 0 where no noise was taken off."""
        return self.smooth[name].doubt if name in self.smooth else 0.0

    def rate(self, name: str) -> Array:
        """Rate of a column, 0 where its noise was not taken off. [1/s]."""
        return (
            self.smooth[name].rate if name in self.smooth else np.zeros_like(self.time)
        )


def joined(courses: Sequence[Course]) -> Course:
    """Lay sweeps end to end: many short arrays cost more than a long one."""
    if len(courses) == 1:
        return courses[0]
    ends = np.cumsum([len(course) for course in courses]).tolist()
    starts = [0, *ends[:-1]]
    measured = dict.fromkeys(name for course in courses for name in course.measured)
    smooth = dict.fromkeys(name for course in courses for name in course.smooth)
    return Course(
        run="",
        kind=None,
        time=np.concatenate([course.time for course in courses]),
        step=np.concatenate([course.step for course in courses]),
        measured={
            name: np.concatenate([course.column(name) for course in courses])
            for name in measured
        },
        smooth={
            name: Smooth(
                np.concatenate([course.level(name) for course in courses]),
                np.concatenate([course.rate(name) for course in courses]),
            )
            for name in smooth
        },
        cycle=np.concatenate([course.cycle for course in courses]),
        repeat=np.concatenate([course.repeat for course in courses]),
        supply_drop=np.concatenate([course.supply_drop for course in courses]),
        direction=np.concatenate([course.direction for course in courses]),
        still=np.concatenate([course.still for course in courses]),
        waiting=np.concatenate([course.waiting for course in courses]),
        rested=np.concatenate([course.rested for course in courses]),
        stood=np.concatenate([course.stood for course in courses]),
        on_stairs=any(course.on_stairs for course in courses),
        yields=any(course.yields for course in courses),
        bends=any(course.bends for course in courses),
        listed=is_table(courses),
        halts=tuple(
            slice(start + halt.start, start + halt.stop)
            for course, start in zip(courses, starts, strict=True)
            for halt in course.halts
        ),
        slices=tuple(map(slice, starts, ends)),
        start=courses[0].start,
    )


def is_table(sweeps: Sequence[Course]) -> bool:
    """Tell whether a recording lists settled points, with a counter for a clock."""
    return all(course.listed for course in sweeps)
