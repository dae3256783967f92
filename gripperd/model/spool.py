"""A spool that sticks where its command turns round, and catches up.

References
----------
.. [1] M. A. A. S. Choudhury, N. F. Thornhill, S. L. Shah, "Modelling valve stiction",
       Control Eng. Pract. 13(5), 641-658, 2005: here the slip jump J is as wide as dead
       band and stick band together, S.
"""

import numpy as np

from gripperd.model.compiled import compiled
from gripperd.model.track import Array

TURNS = 0.1
"""Share of the band by which a command has to turn round: less is its own noise. [-]"""


def sticking(command: Array, band: float, state: Array) -> Array:
    """Follow a command, but stick where it turns until it is a band away [1]_.

    Parameters
    ----------
    command
        Shape ``(n,)``.
    band
        S, in units of the command.
    state
        Shape ``(3,)``: where it is; which way it slides, or 0 stuck; how far the
        command came. It begins stuck, and at the first sample if that is not known.
    """
    return compiled(_sticking)(command, band, state)


def slides(command: Array, followed: Array, band: float) -> float:
    """Tell which way a spool slid when it began, or 0 if it stuck.

    What came before is not known, but within the first band of the command a spool that
    sticks does nothing.

    Parameters
    ----------
    command, followed
        What was asked and what came of it, shape ``(n,)``.
    band
        In units of both.
    """
    asked = command - command[0]
    beyond = np.flatnonzero(np.abs(asked) > band)
    if not beyond.size:
        return 0.0
    way = float(np.sign(asked[beyond[0]]))
    within = np.flatnonzero(way * asked[: beyond[0]] > band / 4)
    went = np.sum(way * (followed[within] - followed[0]))
    return way if went > 0.5 * np.sum(way * asked[within]) else 0.0


def _sticking(command: Array, band: float, state: Array) -> Array:
    out = np.empty_like(command)
    last, way, end = state[0], state[1], state[2]
    for index in range(command.size):
        goal = command[index]
        if np.isnan(last):
            last = goal
        if np.isnan(way):
            way = 0.0
        if np.isnan(end):
            end = goal
        if way * (end - goal) > TURNS * band:
            way = 0.0
        if way == 0 and abs(goal - last) > band:
            way, end = np.sign(goal - last), goal
        if way * (goal - end) >= 0 and way * (goal - last) > 0:
            last, end = goal, goal
        out[index] = last
    state[0], state[1], state[2] = last, way, end
    return out
