"""What a correction of each signal may depend on, as measured."""

from collections.abc import Mapping, Sequence
from types import MappingProxyType

import numpy as np

from gripperd.diagnose.readings.columns import BY_QUANTITY, Column
from gripperd.diagnose.readings.course import Course
from gripperd.diagnose.residuals.problem import Problem
from gripperd.model.effect import Signal
from gripperd.model.track import Array

LEAST = 1e-9
"""Spread below which a quantity was not varied, of its size. [-]"""

DIRECTION = Column("direction", "direction")
RATE = Column("contraction_rate_per_s", "rate", "1/s")
SWEEP_TIME = Column("time_in_sweep_s", "time", "s")


def _listed(*quantities: str, other: tuple[Column, ...] = ()) -> tuple[Column, ...]:
    return (*(BY_QUANTITY[name] for name in quantities), *other, SWEEP_TIME)


REGRESSORS: Mapping[Signal, tuple[Column, ...]] = MappingProxyType(
    {
        Signal.PRESSURE: _listed("current", "supply"),
        Signal.FORCE: _listed(
            "pressure", "contraction", "temperature", "supply", other=(DIRECTION, RATE)
        ),
        Signal.OPENING: _listed("contraction", "force", other=(DIRECTION,)),
        Signal.GRIP: _listed("force", "opening", other=(DIRECTION,)),
    }
)
"""Quantities of each signal. The clock is none: a correction has to hold tomorrow."""


def listed(problem: Problem, signal: Signal) -> tuple[Column, ...]:
    """What a correction of a signal may depend on: a grip without a cell, as a pull."""
    blind = signal is Signal.GRIP and problem.is_blind
    return REGRESSORS[Signal.FORCE if blind else signal]


def varied(
    train: Problem, test: Problem, listed: Sequence[Column]
) -> tuple[Column, ...]:
    """Those that were measured everywhere, and varied."""
    ours, theirs = (inputs(part, listed) for part in (train, test))
    known = np.isfinite(ours).all(0) & np.isfinite(theirs).all(0)
    size = np.max(np.abs(ours), axis=0, initial=0.0)
    good = known & (np.ptp(ours, axis=0) > LEAST * size)
    return tuple(one for one, kept in zip(listed, good, strict=True) if kept)


def ranges(
    problem: Problem, listed: Sequence[Column]
) -> dict[Column, tuple[float, float]]:
    """Lowest and highest of each quantity that was measured anywhere. [SI]."""
    values = zip(listed, inputs(problem, listed).T, strict=True) if listed else ()
    known = {one: found[np.isfinite(found)] for one, found in values}
    return {
        one: (float(found.min()), float(found.max()))
        for one, found in known.items()
        if found.size
    }


def inputs(problem: Problem, listed: Sequence[Column]) -> Array:
    """Quantities of every sample to explain, shape ``(n, k)``. [SI]."""
    return np.concatenate(
        [
            np.column_stack(
                [
                    level(problem.courses[block.course], one.quantity)[block.good]
                    for one in listed
                ]
            )
            for block in problem.blocks
        ]
    )


def level(course: Course, quantity: str) -> Array:
    """Give one quantity over a sweep, NaN where it is not known, shape ``(n,)``. [SI].

    Beside columns there are ``direction`` of travel, ``rate`` of contraction, and
    ``time`` since the start of the sweep.
    """
    match quantity:
        case "direction":
            return course.direction
        case "rate" if "contraction" in course.smooth:
            return course.smooth["contraction"].rate
        case "time":
            return np.asarray(course.time - course.time[0])
        case _:
            return course.level(quantity)
