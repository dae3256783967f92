"""Operators that remember: lag, trail, delay, play and stop.

Each walks one sequence and carries its state in an array that the caller keeps, so
that a run may be given whole or sample by sample with the same result. A state of NaN
has not begun: it settles at the first sample. A sample of NaN is not known: within a
call, the one before it holds on.

References
----------
.. [1] M. Brokate, J. Sprekels, "Hysteresis and Phase Transitions", Springer, 1996,
       section 2.3: play and stop.
.. [2] P. R. Dahl, "Solid friction damping of mechanical vibrations", AIAA J. 14(12),
       1675-1682, 1976.
"""

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from gripperd.model.compiled import compiled

Array: TypeAlias = NDArray[np.float64]

KEPT = 1024
"""Samples that a delay remembers from call to call: one second at 1 kHz."""


def begin(size: int = 1) -> Array:
    """State of operators that have not seen a sample yet."""
    return np.full(size, np.nan)


def lag(signal: Array, step: Array, constant: float, state: Array) -> Array:
    """First-order lag, exact for a signal that is constant between samples.

    Parameters
    ----------
    signal
        What is followed, shape ``(n,)``.
    step
        Time since the sample before, shape ``(n,)``. [s]
    constant
        Time constant. [s]
    state
        What has followed so far, shape ``(1,)``; it is moved on.
    """
    return compiled(_lag)(signal, step, constant, state)


def trail(signal: Array, step: Array, constant: float, state: Array) -> Array:
    """First-order lag, exact for a signal that goes straight from sample to sample.

    Parameters
    ----------
    signal, step, constant
        As for :func:`lag`.
    state
        What has followed so far, and where the signal was, shape ``(2,)``; it is moved
        on.
    """
    return compiled(_trail)(signal, step, constant, state)


def delay(signal: Array, time: Array, late: float, state: Array) -> Array:
    """What a signal was some time ago, between samples on a straight line.

    Before the first sample it was the first value; what is not known lies on the line
    between what is. Given sample by sample, it looks back over the last :data:`KEPT`.

    Parameters
    ----------
    signal, time
        What comes late, and when it was; shape ``(n,)``. [any, s]
    late
        By how much. [s]
    state
        Times and values of the past, shape ``(2, KEPT)``; it is moved on.
    """
    if late == 0 or not signal.size:
        return signal
    past = np.hstack([state[:, ~np.isnan(state[0])], np.stack([time, signal])])
    last = past[:, -KEPT:]
    state[:, KEPT - last.shape[1] :] = last
    known = past[:, ~np.isnan(past[1])]
    if not known.size:
        return np.full_like(signal, np.nan)
    return np.interp(time - late, *known)


def play(signal: Array, radius: float | Array, state: Array) -> Array:
    """Lost motion: follows the signal at a distance of at most the radius.

    The state, shape ``(1,)``, is the last output; it begins at the first sample. The
    radius may change from sample to sample.
    """
    return compiled(_play)(signal, radius * np.ones_like(signal), state)


def dahl(
    signal: Array, direction: Array, share: Array, distance: float, state: Array
) -> Array:
    """Sign of dry friction, which turns round over a distance after a reversal.

    Dahl's model with exponent 1: the sign nears a share of the direction by ``1 - 1/e``
    in each distance gained in it [2]_. At rest it stays; where one of the three is not
    known, neither is it. The state, shape ``(2,)``, holds how far the signal came and
    the sign, which begins at the direction.
    """
    return compiled(_dahl)(signal, direction, share, distance, state)


def stop(signal: Array, radius: float, state: Array) -> Array:
    """Elastic until it slips: signal minus its play, between -radius and +radius.

    The state, shape ``(1,)``, is that of the play.
    """
    return signal - play(signal, radius, state)


def leaked(
    signal: Array,
    step: Array,
    still: Array,
    law: tuple[float, float, float],
    state: Array,
) -> Array:
    """Part of a signal that is lost while it stands still and filled up as it moves.

    What is left sinks as ``dx/dt = -k x^(1 + n)``. It does while it is filled up: as
    much is missing in the end as is lost in the time constant. No more is missing of a
    signal that moves than it is above what was left: the rest is let out.

    Parameters
    ----------
    signal
        What leaks, shape ``(n,)``.
    step, still
        Time since the sample before, and since the signal last moved. [s]
    law
        Share lost per time where the signal is 1 [1/s], the exponent n, above -1, by
        which that changes with the signal, and time constant of filling up. [s]
    state
        What is lost so far, and what was left when the signal last stood still, shape
        ``(2,)``; it is moved on.
    """
    return compiled(_leaked)(signal, step, still, law, state)


def _lag(signal: Array, step: Array, constant: float, state: Array) -> Array:
    out = np.empty_like(signal)
    last = goal = state[0]
    for index in range(signal.size):
        if not np.isnan(signal[index]):
            goal = signal[index]
        if np.isnan(last):
            last = goal
        last = goal + (last - goal) * np.exp(-step[index] / constant)
        out[index] = last
    state[0] = last
    return out


def _trail(signal: Array, step: Array, constant: float, state: Array) -> Array:
    out = np.empty_like(signal)
    last, came = state
    for index in range(signal.size):
        goal = came if np.isnan(signal[index]) else signal[index]
        if np.isnan(last):
            last = came = goal
        share = step[index] / constant
        behind = (goal - came) * (-np.expm1(-share) / share if share > 0 else 1.0)
        last = goal - behind + (last - came) * np.exp(-share)
        came = goal
        out[index] = last
    state[:] = last, came
    return out


def _play(signal: Array, radius: Array, state: Array) -> Array:
    out = np.empty_like(signal)
    last = state[0]
    for index in range(signal.size):
        goal = signal[index]
        if np.isnan(last):
            last = goal
        last = min(max(last, goal - radius[index]), goal + radius[index])
        out[index] = last
    state[0] = last
    return out


def _dahl(
    signal: Array, direction: Array, share: Array, distance: float, state: Array
) -> Array:
    out = np.empty_like(signal)
    last, sign = state[0], state[1]
    for index in range(signal.size):
        toward, goal = direction[index], share[index] * direction[index]
        if np.isnan(signal[index]) or np.isnan(goal):
            out[index] = np.nan
            continue
        if np.isnan(last) or np.isnan(sign):
            last, sign = signal[index], toward
        # Noise goes to and fro: only what is gained counts.
        gained = (signal[index] - last) * np.sign(toward)
        if gained > 0:
            last = signal[index]
        kept = np.exp(-max(gained, 0.0) / distance) if distance > 0 else 0.0
        sign = goal + (sign - goal) * kept
        out[index] = sign
    state[0], state[1] = last, sign
    return out


def _leaked(
    signal: Array,
    step: Array,
    still: Array,
    law: tuple[float, float, float],
    state: Array,
) -> Array:
    out = np.empty_like(signal)
    rate, bend, refill = law
    lost, rested = state[0], state[1]
    value = np.nan
    for index in range(signal.size):
        if not np.isnan(signal[index]):
            value = signal[index]
        left = value - lost
        if still[index] > 0 and left > 0 and rate > 0:
            # x^-n grows by n k t.
            gone = rate * step[index] * left**bend
            if bend * gone <= -1:
                left = 0.0
            elif bend == 0:
                left *= np.exp(-gone)
            else:
                left *= np.exp(-np.log1p(bend * gone) / bend)
            lost, rested = value - left, left
        elif still[index] <= 0:
            fed = 0.0
            if left > 0 and rate > 0:
                fed = min(refill * rate * left ** (1 + bend), left)
            lost = min(lost, value - rested)
            lost = fed + (lost - fed) * np.exp(-step[index] / refill)
        lost = max(min(lost, value), 0.0)
        out[index] = lost
    state[0], state[1] = lost, rested
    return out
