"""A muscle that is slack: what its cell reads then is the zero of the cell.

A muscle cannot push. Where its model says that it would, it hangs through, and a
reading that is the same at all lengths, but for a drift, tells nothing of it.
"""

import numpy as np

from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.model.effect import Signal

PUSHES = 0.5
"""Share of the force from which a muscle is taut by which it would have to push. [-]"""
MANY = 20
"""Readings that tell a zero."""
FEWEST = 8
"""The same where they stay while the model would have them change."""
STAYS = 5.0
"""Times more than they do. [-]"""
SAME = 2.0
"""Standard deviations of a reading within which they are the same. [-]"""
NEAR = 0.5
"""Share of the force from which a muscle is taut up to which a zero does not matter:
what is read of a slack one hardly ever comes so far. [-]"""
MOST = 0.1
"""Share of the largest force by which the zero of a cell is off, at most. [-]"""


def zero_of_slack(problem: Problem, taut: float, *, pushes: bool) -> float | None:
    """Tell what a cell reads of a muscle that hangs through. [N].

    Parameters
    ----------
    problem
        At the nominal constants, with all its readings.
    taut
        Force from which a muscle is taut, were the zero right. [N]
    pushes
        Whether it reads that a muscle pushes: a zero that is too low, if what it
        reads stays the same where one that is held would push more and less.

    Returns
    -------
    The highest such reading, 0 if that is near 0; none where nothing hangs through, or
    readings differ.
    """
    blocks = [
        index for index, b in enumerate(problem.blocks) if b.signal is Signal.FORCE
    ]
    if not blocks:
        return None
    point = Point(np.zeros(len(problem.constants)))
    told = problem.expected(problem.explanation(point), frozenset({Signal.FORCE}))
    expected, measured, time = (
        np.concatenate([each[index] for index in blocks])
        for each in (told, problem.measured, problem.times)
    )
    slack = expected < -PUSHES * taut
    if slack.sum() < FEWEST:
        return None
    few = slack.sum() < MANY
    clock = time[slack] - time[slack].mean()
    line = np.column_stack([np.ones_like(clock), clock])
    read = np.column_stack([measured[slack], (measured - expected)[slack]])
    drift = line @ np.linalg.lstsq(line, read, rcond=None)[0]
    of_slack, of_held = np.std(read - drift, axis=0)
    zero = float(np.max(drift[:, 0]))
    same = SAME * problem.noises[Signal.FORCE].std
    if abs(zero) >= MOST * problem.full_scale[Signal.FORCE]:
        return None
    if of_slack >= same or (pushes and of_held < same):
        return None
    # Of one sweep a drift is not told from the push of a muscle that is held.
    if few and np.std(expected[slack]) < STAYS * np.std(measured[slack]):
        return None
    return zero if abs(zero) > NEAR * taut else 0.0
