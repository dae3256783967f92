"""Held-out sweeps under conditions that no other sweep has seen: judged apart."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from gripperd.diagnose.readings.course import Course
from gripperd.diagnose.readings.fault import Mask
from gripperd.diagnose.residuals.holdout import MARGIN, Split
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.residuals.regressors import level
from gripperd.diagnose.verdict.gap import Gap, gaps
from gripperd.model.effect import Signal
from gripperd.model.track import Array

CONDITIONS = ("current", "pressure", "contraction", "temperature", "rate")
"""What a sweep may go further in; the rate is that of the contraction."""
TAILS = (0.01, 0.99)
"""Quantiles that stand for the ends of a sweep: a single sample is noise."""


@dataclass(frozen=True, slots=True)
class Extrapolation:
    """How far simulation and measurement are apart beyond what was searched."""

    runs: tuple[str, ...]
    """Names of the sweeps that lie there."""
    gaps: Mapping[Signal, Gap]


def apart(parts: Split) -> tuple[Problem, Problem | None]:
    """Give the held-out sweeps inside what was searched, and those beyond it.

    A sweep is beyond when it leaves the range of the searched samples in any condition:
    current, pressure, contraction, its rate, or temperature. Where a signal would go
    unjudged without them, they stay in the test as well.
    """
    searched, test = parts.train, parts.test
    beyond = [
        bool(mask.any()) and _leaves(searched.courses, searched.kept, course, mask)
        for course, mask in zip(test.courses, test.kept, strict=True)
    ]
    if not any(beyond):
        return test, None
    outside = _kept(test, beyond)
    inside = _kept(test, [not one for one in beyond])
    complete = set(inside.signals) == set(test.signals)
    return inside if complete else test, outside if outside.blocks else None


def extrapolation(
    parts: Split, outside: Problem | None, points: Sequence[Point], seed: int
) -> Extrapolation | None:
    """Judge what lies beyond what was searched, as :func:`gaps` does.

    Parameters
    ----------
    parts
        What was searched, and what was left out.
    outside
        Of the latter what lies beyond the former; see :func:`apart`.
    points
        The model as it came, with the best constants, and with the effects.
    seed
        Of the interval.
    """
    if outside is None:
        return None
    judged = gaps(outside, points, np.random.default_rng(seed))
    return Extrapolation(swept(parts, outside), judged)


def swept(parts: Split, part: Problem) -> tuple[str, ...]:
    """Names of those held-out sweeps that belong to a part of the test."""
    pairs = zip(parts.test.kept, part.kept, strict=True)
    there = [bool(chosen.any()) for mask, chosen in pairs if mask.any()]
    return tuple(name for name, one in zip(parts.runs, there, strict=True) if one)


def _kept(problem: Problem, chosen: Sequence[bool]) -> Problem:
    return replace(
        problem,
        kept=tuple(mask & one for mask, one in zip(problem.kept, chosen, strict=True)),
    )


def _leaves(
    courses: Sequence[Course], kept: Sequence[Mask], course: Course, mask: Mask
) -> bool:
    for name in CONDITIONS:
        own = _known(course, name, mask)
        if not own.size:
            continue
        seen = np.concatenate(
            [_known(one, name, part) for one, part in zip(courses, kept, strict=True)]
        )
        if not seen.size:
            return True
        low, high = np.quantile(own, TAILS)
        margin = MARGIN * float(np.ptp(seen))
        if low < seen.min() - margin or high > seen.max() + margin:
            return True
    return False


def _known(course: Course, name: str, mask: Mask) -> Array:
    values = level(course, name)[mask]
    return values[np.isfinite(values)]
