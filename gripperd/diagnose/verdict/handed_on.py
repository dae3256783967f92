"""Grips that the force of the same sweep does not account for.

A grip is foretold from the measured force, so that whatever a cell in the muscle drifts
the grip seems to drift, the other way and less by the ratio of the jaws. The two added
up have none of it: a grip that is off in a sweep in which the force is not is no drift
of that cell.
"""

from collections.abc import Iterator, Sequence

import numpy as np

from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.residuals.ranges import ranges
from gripperd.diagnose.verdict.structure import VISIBLE, WANDERS, chi_square_tail
from gripperd.model.effect import Signal
from gripperd.model.track import Array

UNLIKELY = 1e-4
"""Chance below which a grip that is off is not one whose cell drifts."""
UNSEEN = VISIBLE / 2
"""Of the largest force, what a muscle does, its model does not, and nobody sees. [-]"""
FEWEST = 8
"""Samples of a sweep that have both, at least."""


def not_handed_on(problem: Problem, residuals: Sequence[Array]) -> dict[Signal, float]:
    """Look at grips and forces together, sweep by sweep.

    Parameters
    ----------
    problem
        The recording and a model that explains its forces.
    residuals
        Measured minus predicted, block by block. [SI]

    Returns
    -------
    How far the grip is off by itself, as a root mean square; empty where no more than
    sound sensors are. [N]
    """
    linkage, noises = problem.model.linkage, problem.noises
    if linkage is None or not {Signal.FORCE, Signal.GRIP} <= set(problem.signals):
        return {}
    sums = list(_sums(problem, residuals, linkage.ratio))
    if not sums:
        return {}
    means = np.array([each.mean() for each in sums])
    counts = np.array([each.size for each in sums])
    grip, force = noises[Signal.GRIP], noises[Signal.FORCE]
    own = grip.drift**2 - (force.drift / linkage.ratio) ** 2
    unseen = UNSEEN * problem.full_scale[Signal.FORCE] / linkage.ratio
    variances = max(own, 0.0) + unseen**2 + grip.slow_variance / counts
    chance = chi_square_tail(float(np.sum(means**2 / variances)), means.size)
    excess = float(np.average(means**2 - variances, weights=counts))
    size = max(excess, 0.0) ** 0.5
    least = max(VISIBLE, WANDERS / means.size**0.5) * ranges(problem)[Signal.GRIP]
    return {Signal.GRIP: size} if chance < UNLIKELY and size > least else {}


def _sums(
    problem: Problem, residuals: Sequence[Array], ratio: float
) -> Iterator[Array]:
    """What is left of the grip and of the force that it takes, of each sweep. [N]."""
    forces = {
        block.course: (block.good, left)
        for block, left in zip(problem.blocks, residuals, strict=True)
        if block.signal is Signal.FORCE
    }
    for block, left in zip(problem.blocks, residuals, strict=True):
        if block.signal is not Signal.GRIP or block.course not in forces:
            continue
        good, pull = forces[block.course]
        both = block.good & good
        if both.sum() >= FEWEST:
            yield left[both[block.good]] + pull[both[good]] / ratio
