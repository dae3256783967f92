"""How much of the noise of a length is heard in the force, reading by reading."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from gripperd.diagnose.noise.model import quick_noise
from gripperd.diagnose.readings.course import Course
from gripperd.diagnose.residuals.doubt import of_length
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.model.effect import Signal
from gripperd.model.track import Array

STILL = 0.3
"""Share of the noise of a force up to which a length adds nothing to it. [-]"""


def with_heard_lengths(problem: Problem, searched: Problem, point: Point) -> Problem:
    """Give the problem with lengths as noisy as the force bears out.

    A display that changes by a step, or a length that is set and not measured, looks
    noisy and is not. Sweeps in which the length travels are louder than those in which
    it is held by the noise of the length, times the slope, if that is noise at all.

    Parameters
    ----------
    problem
        With lengths as noisy as they look.
    searched
        The part of it that may tell.
    point
        Near enough for what neighbours differ by.
    """
    told = [
        (residual, float(np.mean(made**2)))
        for block, residual in zip(
            searched.blocks, searched.residuals(point), strict=True
        )
        if block.signal is Signal.FORCE
        for made in [of_length(searched.model, searched.courses[block.course], block)]
    ]
    share = _share(told)
    heard = tuple(_heard(course, share**0.5) for course in problem.courses)
    return replace(problem, courses=heard)


def _share(told: Sequence[tuple[Array, float]]) -> float:
    """Share of what lengths make of forces that is there, as variances. [-].

    Where a length makes m of a variance that is 1 with all of it, and it is q, the
    share is 1 - (1 - q) / m.
    """
    square = quick_noise(residual for residual, _ in told).std ** 2
    held = [residual for residual, made in told if made < STILL**2 * square]
    travels = [(residual, made) for residual, made in told if made >= STILL**2 * square]
    if not (held and travels):
        return 0.0
    quiet = quick_noise(held).std ** 2
    whole = [quiet + made for _, made in travels]
    found = quick_noise(
        residual / one**0.5 for (residual, _), one in zip(travels, whole, strict=True)
    )
    sizes = [residual.size for residual, _ in travels]
    made = np.average(1 - quiet / np.array(whole), weights=sizes)
    return float(np.clip(1 - (1 - found.std**2) / made, 0.0, 1.0))


def _heard(course: Course, share: float) -> Course:
    known = {
        name: course.smooth[name]._replace(doubt=share * course.doubt(name))
        for name in ("length", "contraction")
        if name in course.smooth
    }
    return replace(course, smooth={**course.smooth, **known})
