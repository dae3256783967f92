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
from gripperd.diagnose.verdict.structure import WANDERS, Structure, chi_square_tail
from gripperd.model.effect import Signal
from gripperd.model.track import Array

ALONG = "the sweep, in which the force is as it should be"
"""Way of looking at what is left."""
UNSEEN = 0.00075
"""Of the largest force, what a muscle does and its model does not, and nobody sees:
half of what would be seen. [-]"""
FEWEST = 8
"""Samples of a sweep that have both, at least."""


def not_handed_on(
    problem: Problem, residuals: Sequence[Array]
) -> tuple[Structure, ...]:
    """Look at grips and forces together, sweep by sweep; none where none has both.

    Parameters
    ----------
    problem
        The recording and a model that explains its forces.
    residuals
        Measured minus predicted, block by block. [SI]
    """
    linkage, noises = problem.model.linkage, problem.noises
    if linkage is None or not {Signal.FORCE, Signal.GRIP} <= set(problem.signals):
        return ()
    sums = list(_sums(problem, residuals, linkage.ratio))
    if not sums:
        return ()
    means = np.array([each.mean() for each in sums])
    sizes = np.array([each.size for each in sums])
    grip, force = noises[Signal.GRIP], noises[Signal.FORCE]
    own = grip.drift**2 - (force.drift / linkage.ratio) ** 2
    unseen = UNSEEN * problem.full_scale[Signal.FORCE] / linkage.ratio
    variances = max(own, 0.0) + unseen**2 + grip.slow_variance / sizes
    total = float(np.sum(means**2 / variances))
    excess = float(np.average(means**2 - variances, weights=sizes))
    beside = Structure(
        Signal.GRIP,
        ALONG,
        total - means.size,
        chi_square_tail(total, means.size),
        max(excess, 0.0) ** 0.5 / ranges(problem)[Signal.GRIP],
        0.0,
        WANDERS / means.size**0.5,
    )
    return (beside,)


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
