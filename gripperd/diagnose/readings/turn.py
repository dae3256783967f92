"""When a way turns that takes a rest there: at its end, with the way back.

A trend goes past the end of a way that is held and comes back, so that it seems to turn
amid the rest. Friction turns round with the way.
"""

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from gripperd.diagnose.noise.smoothing import Smooth
from gripperd.diagnose.noise.trend import RARE
from gripperd.diagnose.readings.fault import Mask
from gripperd.diagnose.readings.travel import reversal
from gripperd.model.track import Array

DEPTH = 5.0
"""Times the way back that counts as reversed, up to which a turn is looked at."""
PART = 0.25
"""The same, of the shorter of its two ways: the longer they are, the better is a rest
told from a round turn. [-]"""
MOST = 64
"""Readings of a turn that are told apart; of more, neighbours are averaged."""
FEWEST = 12
"""The least that two ways and a rest are told from."""
FOREIGN = 2.0
"""Times what noise leaves of a turn, from which it is of another shape. [-]"""


class Turned(NamedTuple):
    """Where a way turns, shape ``(n,)`` each."""

    signs: Array
    """Of its travel; 0 before there was any."""
    unsure: Mask
    """Samples before or after a turn, nobody knows which."""


class Left(NamedTuple):
    """When a way leaves its rest."""

    time: float
    """[s]"""
    likelier: float
    """Than a round turn, which takes none. [nat]"""


def turned(signs: Array, time: Array, column: Array, known: Smooth) -> Turned:
    """Let a way turn where the rest ends that it takes there, if it takes one.

    Parameters
    ----------
    signs
        Of the travel, as a trend has it, shape ``(n,)``; 0 before there was any.
    time
        Rising, shape ``(n,)``. [s]
    column
        The readings that the trend was laid through.
    known
        The trend.
    """
    found = Turned(signs.copy(), np.zeros(signs.size, dtype=bool))
    turns = 1 + np.flatnonzero(signs[1:] * signs[:-1] < 0)
    if not (turns.size and known.variance > 0 and np.isfinite(column).all()):
        return found
    least = DEPTH * reversal(known.spread)
    places = [0, *turns.tolist(), signs.size]
    for (start, place), end in zip(pairwise(places), places[2:], strict=False):
        came = signs[place - 1]
        way = came * known.value
        ways = np.ptp(way[start:place]), np.ptp(way[place:end])
        low = way < way[start:end].max() - max(least, PART * min(ways))
        first = start + int(np.append(0, np.flatnonzero(low[start:place]))[-1])
        last = place + int(np.append(np.flatnonzero(low[place:end]), end - place)[0])
        rows = slice(first, last)
        left = _left(time[rows], came * column[rows], known.variance)
        if left is None or left.likelier < -RARE:
            continue
        turn = first + int(np.searchsorted(time[rows], left.time, side="right"))
        apart = slice(min(turn, place), max(turn, place))
        if left.likelier > RARE:
            found.signs[apart] = came if turn > place else -came
        else:
            found.unsure[apart] = True
    return found


def _left(time: Array, way: Array, variance: float) -> Left | None:
    """When a way leaves the rest at its end; none where it has another shape."""
    share = -(-time.size // MOST)
    count = time.size // share
    if count < FEWEST:
        return None
    t, y = (one[: count * share].reshape(count, share).mean(1) for one in (time, way))
    straight, rounded = (_misfits(t, y, t, t, power) for power in (1, 2))
    begins, ends = np.unravel_index(int(np.argmin(straight)), straight.shape)
    rest, turn = float(straight[begins, ends]), float(rounded.diagonal().min())
    noise = variance / share
    if min(rest, turn) > FOREIGN * count * noise:
        return None
    near = time[np.abs(time - t[ends]) <= float(np.diff(t).max())]
    exact = int(np.argmin(_misfits(time, way, t[[begins]], near, 1)))
    return Left(float(near[exact]), 0.5 * (turn - rest) / noise)


def _misfits(time: Array, way: Array, begins: Array, ends: Array, power: int) -> Array:
    """Sum of squares that each rest leaves, shape ``(begins, ends)``.

    Ways come there and go with a power of the time; without a rest where it ends as it
    begins. What is no turn leaves infinitely much.
    """
    came = np.maximum(begins[:, None] - time, 0.0) ** power
    went = np.maximum(time - ends[:, None], 0.0) ** power
    came, went = (one - one.mean(axis=1, keepdims=True) for one in (came, went))
    off = way - way.mean()
    one, other = (came**2).sum(1)[:, None], (went**2).sum(1)[None, :]
    both, of_one, of_other = came @ went.T, (came @ off)[:, None], (went @ off)[None, :]
    with np.errstate(divide="ignore", invalid="ignore"):
        steep = (of_one * other - of_other * both) / (one * other - both**2)
        back = (of_other * one - of_one * both) / (one * other - both**2)
        misfit = off @ off - (steep * of_one + back * of_other)
    is_turn = (begins[:, None] <= ends[None, :]) & (steep < 0) & (back < 0)
    return np.where(is_turn & np.isfinite(misfit), misfit, np.inf)
