"""Dwells: stretches in which the command rests, each judged about a level of its own.

Where a model misses a force by far more than the noise, what it misses stays the same
as long as nothing moves. So how the force changes in a dwell is known as well as the
noise lets it, however far off its level is.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from gripperd.diagnose.fit.cross_validation import bears_out
from gripperd.diagnose.fit.polish import Polished
from gripperd.diagnose.noise.drift import Quiet, hold
from gripperd.diagnose.noise.model import Noise
from gripperd.diagnose.noise.whitening import whitened
from gripperd.diagnose.readings.course import Course
from gripperd.diagnose.readings.fault import Mask
from gripperd.diagnose.residuals.block import Block
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.residuals.quiet import HELD
from gripperd.diagnose.search.price import MUCH
from gripperd.model.effect import Signal
from gripperd.model.track import Array

SETTLED = 1.0
"""Time after a command before which a force shows but the step: a load that hangs on a
muscle swings for ten times the 60 to 110 ms in which the length follows. [s]"""
SHORTEST = 3.0
"""A shorter dwell tells little but how a step dies away. [s]"""
SAMPLES = 8
"""Fewer leave too little beside a level and two ways of creeping."""
STILL = 0.01
"""Change of the contraction up to which nothing moves: the creep of a hanging load is
0.2 to 0.4 % of the length per decade of time. [-]"""
FEW = 5
"""Dwells from which a law can be told: fewer may each have a chance of its own."""


def dwelling(problem: Problem, point: Point, noise: Noise) -> Problem:
    """Give the problem with the dwells of the force, if there are enough.

    Parameters
    ----------
    problem
        With the noise as loud as the misfit.
    point
        The best explanation; what it leaves of a dwell, but for its level and the ways
        in which rubber creeps, tells how loud dwells are.
    noise
        Of the force, as identified. [N]

    Returns
    -------
    The problem with a block for each dwell, last; as it came with fewer than
    :data:`FEW` of them.
    """
    dwells = tuple(_dwells(problem))
    if len(dwells) < FEW:
        return problem
    within = _within(replace(problem, dwells=dwells), point)
    squares, free = 0.0, 0
    for quiet in within:
        rest = _unforeseen(quiet, noise)
        squares += float(rest @ rest)
        free += rest.size - quiet.regressors.shape[1]
    louder = _about(noise, problem.noises[Signal.FORCE].std, squares / free)
    return replace(problem, dwells=tuple(one._replace(noise=louder) for one in dwells))


def misfit(problem: Problem, point: Point, signal: Signal) -> float:
    """Chi² of the dwells of a signal, each about a level of its own. [-].

    Parameters
    ----------
    problem
        With dwells; without, nothing is off.
    point
        The explanation.
    signal
        Whose dwells.
    """
    residuals = problem.residuals(point)
    total = 0.0
    for index in dwells_of(problem, signal):
        white = problem.white([residuals[index]], index)
        total += float(np.sum(white**2))
    return total


def stilled(problem: Problem, before: Polished, after: Polished) -> bool:
    """Whether much of the way in which the force drifts in the dwells is gone.

    Other sweeps must foretell each better as well.

    Parameters
    ----------
    problem
        With dwells.
    before, after
        Without and with a cause of the drift.
    """
    drift, left = (drifted(problem, fit.point) for fit in (before, after))
    gone = drift - left > MUCH * drift
    return gone and bears_out(problem, before, after, [Signal.FORCE])


def drifted(problem: Problem, point: Point) -> float:
    """What an explanation leaves of the way the force drifts in the dwells.

    Parameters
    ----------
    problem
        With dwells.
    point
        The explanation.

    Returns
    -------
    Sum of squares over all samples of the dwells. [N²]
    """
    total = 0.0
    for quiet in _within(problem, point):
        slow = quiet.regressors - quiet.regressors.mean(0)
        seen = slow @ np.linalg.lstsq(slow, quiet.residual, rcond=None)[0]
        total += float(seen @ seen)
    return total


def _within(problem: Problem, point: Point) -> Iterator[Quiet]:
    """What is left in each dwell, beside its level and the ways of creeping."""
    residuals = problem.residuals(point)
    for index in dwells_of(problem, Signal.FORCE):
        yield hold(problem.times[index], residuals[index], creeps=True)


def dwells_of(problem: Problem, signal: Signal) -> list[int]:
    """Give the places of the dwells of a signal among the blocks: last."""
    first = len(problem.blocks) - len(problem.dwells)
    return [
        first + place
        for place, dwell in enumerate(problem.dwells)
        if dwell.signal is signal
    ]


def _dwells(problem: Problem) -> Iterator[Block]:
    """Dwells of the force; what came before the first command is not known."""
    top = problem.highest.get(Signal.PRESSURE, 0.0)
    for block in problem.blocks:
        if block.signal is not Signal.FORCE:
            continue
        course = problem.courses[block.course]
        for stretch in stretches(course):
            good = block.good & stretch & (course.still >= SETTLED)
            if good.sum() < SAMPLES or np.ptp(course.time[good]) < SHORTEST:
                continue
            if _is_still(course, good, top):
                yield block._replace(good=good)


def _is_still(course: Course, good: Mask, top: float) -> bool:
    """Whether neither length nor pressure changes by more than rubber creeps."""
    moved, pressed = (
        float(np.ptp(course.level(name)[good])) for name in ("contraction", "pressure")
    )
    return moved < STILL and pressed < HELD * top


def stretches(course: Course) -> Iterator[Mask]:
    """Give the samples from each command to the next."""
    commands = np.cumsum(np.diff(course.still, prepend=0.0) < 0)
    for number in range(1, int(commands.max(initial=0)) + 1):
        yield commands == number


def _unforeseen(quiet: Quiet, noise: Noise) -> Array:
    columns = np.column_stack([quiet.regressors, quiet.residual])
    white = whitened(columns, quiet.time, noise)
    known, left = white[:, :-1], white[:, -1]
    return np.asarray(left - known @ np.linalg.lstsq(known, left, rcond=None)[0])


def _about(noise: Noise, level: float, share: float) -> Noise:
    """The same noise, louder, about a level known no better than so: it wanders alike.

    A drift of size s and memory m wanders by ``s (2 t / m)^½`` in a short time t.
    """
    factor = max(share, 1.0) ** 0.5
    drift = factor * noise.drift
    level = max(level, drift)
    memory = noise.memory * (level / drift) ** 2
    return replace(noise, std=factor * noise.std, drift=level, memory=memory)
