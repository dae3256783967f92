"""Step responses: how the pressure follows the command, each about a level of its own.

Right after a step no two sensors see the same instant, so elsewhere those samples are
passed over. But a regulator is slow by more than that, and only there does it show.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from gripperd.diagnose.fit.polish import Polished
from gripperd.diagnose.noise.model import Noise
from gripperd.diagnose.residuals.block import Block
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.dwell import FEW, SAMPLES, SETTLED, dwells_of, stretches
from gripperd.diagnose.search.price import PHANTOM
from gripperd.model.effect import Signal

STEADY = 1e4
"""Time in which the level of a response forgets: it stays. [s]"""
RESPONDS = "response.valve"
"""Constant by which a regulator is late, as one lag."""

QUICK = 0.025
"""Least response time that makers state of common regulators: the model has none at
all, and steps show what is slower. [s]"""
TRIED = 4
"""Response times up to that which are tried."""


def with_responses(problem: Problem, point: Point, noise: Noise) -> Problem:
    """Give the problem with the responses to steps, if there are enough.

    Parameters
    ----------
    problem
        With the noise as loud as the misfit.
    point
        The best explanation; what it leaves of the responses tells how loud they are.
    noise
        Of the pressure, as identified. [Pa]

    Returns
    -------
    The problem with a block for each response, last; as it came with fewer than
    :data:`FEW` of them.
    """
    responses = tuple(_responses(problem))
    if len(responses) < FEW:
        return problem
    level = problem.noises[Signal.PRESSURE].std
    left = _rms(replace(problem, dwells=responses), point)
    own = Noise(max(left, noise.std), 0.0, level, STEADY)
    louder = (response._replace(noise=own) for response in responses)
    return replace(problem, dwells=(*problem.dwells, *louder))


def _rms(problem: Problem, point: Point) -> float:
    """Root mean square of what an explanation leaves of the responses. [Pa]."""
    left = np.concatenate(problem.residuals(point)[-len(problem.dwells) :])
    return float(np.mean(left**2) ** 0.5)


def closes_responses(problem: Problem, before: Polished, after: Polished) -> bool:
    """Whether an explanation closes much that a quick regulator would not.

    All responses have one law of a few numbers; none has to be left out to try it.
    What counts is what a cause closes beyond any regulator as quick as :data:`QUICK`,
    as a share of what one without any lag leaves.

    Parameters
    ----------
    problem
        With responses.
    before, after
        Without and with a cause of slow responses.
    """
    place = [constant.path for constant in problem.constants].index(RESPONDS)
    slow = problem.constants[place]
    quick = []
    for lag in np.linspace(0.0, QUICK, TRIED):
        shifts = before.point.shifts.copy()
        shifts[place] = (lag - slow.nominal) / slow.sigma
        quick.append(_left(problem, replace(before.point, shifts=shifts)))
    at_once = quick[0]
    return min(quick) - _left(problem, after.point) > PHANTOM * at_once


def _left(problem: Problem, point: Point) -> float:
    """Chi² of the responses, with each command from its own row on or from the next.

    A recorder may write a command before or after it is sent.
    """
    rows = [0.0, 0.0]
    residuals = problem.residuals(point)
    for index in dwells_of(problem, Signal.PRESSURE):
        expected = problem.measured[index] - residuals[index]
        for late in (0, 1):
            told = np.concatenate([expected[:late], expected])[: expected.size]
            white = problem.white([problem.measured[index] - told], index)
            rows[late] += float(np.sum(white**2))
    return min(rows)


def _responses(problem: Problem) -> Iterator[Block]:
    """From the row before each command to a second after it, if it rests so long."""
    for block in problem.blocks:
        if block.signal is not Signal.PRESSURE:
            continue
        course = problem.courses[block.course]
        known = np.isfinite(course.column("pressure") + course.column("current"))
        if problem.kept:
            known &= problem.kept[block.course]
        for stretch in stretches(course):
            if course.still[stretch].max() < SETTLED:
                continue
            good = stretch & (course.still < SETTLED)
            good[:-1] |= good[1:]
            if known[good].all() and good.sum() >= SAMPLES:
                yield block._replace(good=good)
