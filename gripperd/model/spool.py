"""A spool that sticks where its command turns or where it has got to, and catches up.

References
----------
.. [1] M. A. A. S. Choudhury, N. F. Thornhill, S. L. Shah, "Modelling valve stiction",
       Control Eng. Pract. 13(5), 641-658, 2005: here the slip jump J is as wide as dead
       band and stick band together, S.
.. [2] K. J. Åström, T. Hägglund, "Advanced PID Control", ISA, 2006, chapter 3: on-off
       control with hysteresis; here of an inlet and an outlet valve.
"""

import numpy as np

from gripperd.model.compiled import compiled
from gripperd.model.track import Array

TURNS = 0.1
"""Share of the band by which a command has to turn round: less is its own noise. [-]"""

PIECES = 8
"""Steps from sample to sample in which a regulator wakes, goes, and rests again."""


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


def waking(
    command: Array, step: Array, band: float, law: tuple[float, float], state: Array
) -> Array:
    """Rest until the command is a band away, go there as a lag, and rest again [2]_.

    Parameters
    ----------
    command
        Shape ``(n,)``; straight from sample to sample.
    step
        Time since the sample before, shape ``(n,)``. [s]
    band
        In units of the command.
    law
        Share of the band that it leaves when it rests [0..1], and speed at which it
        sets out, in units of the command. [1/s]
    state
        Shape ``(3,)``: where it is; 1 awake, or 0; the command so far. It begins
        asleep, and at the first sample if that is not known.
    """
    return compiled(_waking)(command, step, band, law, state)


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


def _waking(
    command: Array, step: Array, band: float, law: tuple[float, float], state: Array
) -> Array:
    out = np.empty_like(command)
    short, speed = law
    last, awake, told = state[0], state[1] > 0, state[2]
    for index in range(command.size):
        goal = told if np.isnan(command[index]) else command[index]
        if np.isnan(told):
            told = goal
        if np.isnan(last):
            last = goal
        kept = np.exp(-step[index] / PIECES * speed / band) if band > 0 else 0.0
        for piece in range(1, PIECES + 1):
            here = told + (goal - told) * piece / PIECES
            awake = awake or abs(here - last) > band
            if awake:
                last = here + (last - here) * kept
                awake = abs(here - last) > short * band
        told = goal
        out[index] = last
    state[0], state[1], state[2] = last, 1.0 if awake else 0.0, told
    return out
