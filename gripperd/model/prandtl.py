"""Prandtl's model of hysteresis: springs in parallel that stick, then slip.

References
----------
.. [1] M. Brokate, J. Sprekels, "Hysteresis and Phase Transitions", Springer, 1996,
       chapter 2: the Prandtl-Ishlinskii operator, a weighted sum of stops.
"""

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from gripperd.model.compiled import compiled
from gripperd.model.memory import begin
from gripperd.model.real import Real, positive_part

Array: TypeAlias = NDArray[np.float64]

SPREAD = 3.0
"""Ratio of neighbouring radii. Three stops this far apart follow a first loading that
is exponential, a hyperbolic tangent or a hyperbola to 2 % of its height, RMS. [-]"""

Forces: TypeAlias = tuple[float, float, float]
"""What each spring carries once it slips, that of the smallest radius first."""


def reaches(radius: float) -> tuple[float, ...]:
    """Ways from rest until each spring slips, the smallest first; as the radius."""
    return tuple(radius * SPREAD**place for place in (-1, 0, 1))


def at_rest() -> Array:
    """Memory of three springs that begin without load at the first sample."""
    return begin(3)


def begin_at(
    signal: Array, radius: float, load: float, memory: Array, kept: float = 0.0
) -> None:
    """Load springs, if they have no past, as a share of what a way from 0 would have.

    Parameters
    ----------
    signal
        The path, shape ``(n,)``.
    radius
        As :func:`carried` has it.
    load
        The share. [-1..1]
    memory
        As :func:`at_rest` gave it, and it is set; or as a call before left it.
    kept
        Share that is left at 0 of what a long way down to it loads. [0..1]
    """
    if signal.size and np.isnan(memory).all():
        ways = np.array(reaches(radius))
        most = (1 + kept) * ways
        came = np.minimum(np.maximum(signal[0], -most), most)
        memory[:] = signal[0] - np.maximum(load * came - kept * ways, -ways)


def begin_after(signal: Array, radius: float, came: float, memory: Array) -> None:
    """Load springs as :func:`begin_at`, but as a long way from anywhere does.

    ``came`` says which way that was, 1 or -1, or a share of it. [-1..1]
    """
    if signal.size and np.isnan(memory).all():
        memory[:] = signal[0] - came * np.array(reaches(radius))


def settled(
    signal: Real, way: Real, radius: float, forces: Forces, kept: float = 0.0
) -> Real:
    """Force that the springs carry after a way up from 0, or after a long way back.

    Parameters
    ----------
    signal
        Where the way ends.
    way
        Above 0 for up.
    radius, forces
        As :func:`carried` has them.
    kept
        As :func:`begin_at` has it.

    Returns
    -------
    Force, of springs that all slip unless the way up was too short for it. [N]
    """
    rising = 1.0 * np.greater(way, 0)
    loads = (
        np.minimum(positive_part(signal) / reach - kept, 1.0)
        for reach in reaches(radius)
    )
    wound = sum(force * load for force, load in zip(forces, loads, strict=True))
    return rising * wound + (1 - rising) * way * sum(forces)


def carried(signal: Array, radius: float, forces: Forces, memory: Array) -> Array:
    r"""Force that the springs carry along a path, however fast it is run.

    .. math:: F = \sum_{i=-1}^{1} w_i \frac{x - P_i(x)}{r_i}, \quad r_i = 3^i r

    with the play P of radius r. After a long way one way it is their sum, after a
    long way back minus their sum.

    Parameters
    ----------
    signal
        The path, shape ``(n,)``.
    radius
        Way that the middle spring goes from rest until it slips, as the signal.
    forces
        As :data:`Forces`. [N]
    memory
        As :func:`at_rest` gave it or the call before left it; it is moved on, but for
        springs that carry nothing, now or in any other call.
    """
    ways = np.array(reaches(radius))
    return compiled(_carried)(signal, ways, np.array(forces) / ways, memory)


def _carried(signal: Array, ways: Array, stiffnesses: Array, memory: Array) -> Array:
    out = np.zeros_like(signal)
    for place in range(ways.size):
        if stiffnesses[place] == 0:
            continue
        last = memory[place]
        for index in range(signal.size):
            goal = signal[index]
            if np.isnan(last):
                last = goal
            last = min(max(last, goal - ways[place]), goal + ways[place])
            out[index] += stiffnesses[place] * (goal - last)
        memory[place] = last
    return out
