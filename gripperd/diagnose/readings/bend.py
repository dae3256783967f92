"""The shapes in which a way turns: with a rest, at a corner, or round."""

from collections.abc import Callable
from typing import NamedTuple, TypeAlias

import numpy as np

from gripperd.diagnose.noise.trend import RARE
from gripperd.model.track import Array

MOST = 64
"""Readings of a turn that are told apart; of more, neighbours are averaged."""
FEWEST = 12
"""The least that two ways and a rest are told from."""
FOREIGN = 1.0
"""Times what noise leaves of what is told apart, that another shape leaves besides.
[-]"""
FINE = 9
"""Times tried from one of these to the next but one."""


class Ways(NamedTuple):
    """How far it is to a turn and from it, by the time, shape ``(..., n)`` each."""

    came: Array
    went: Array


Shape: TypeAlias = Callable[[Array, Array, Array], Ways]
"""By the time, and when a turn begins and ends."""


class Turn(NamedTuple):
    """From when to when nobody knows whether a way has turned."""

    begins: float
    """[s]"""
    ends: float
    """[s]"""


class _Bend(NamedTuple):
    """The turn of a shape that comes nearest."""

    ends: float
    """When the way back has its speed. [s]"""
    turns: float
    """When a steady acceleration from one speed to the other turns. [s]"""
    misfit: float
    """Sum of squares that it leaves."""


class _Misfit(NamedTuple):
    """Of each turn, shape ``(begins, ends)``."""

    squares: Array
    """Their sum; infinite where no reading lies on one of the ways."""
    halted: Array
    """Part of it after which the way there has come to a halt. [-]"""


def bend(time: Array, way: Array, variance: float, trend: float) -> Turn | None:
    """When a way turns, by each shape that is about as likely as the nearest.

    None where it has another shape.

    Parameters
    ----------
    time
        Rising, shape ``(n,)``. [s]
    way
        Readings that rise and fall again, shape ``(n,)``.
    variance
        Of their noise.
    trend
        When their trend turns, which knows best of what is round. [s]
    """
    share = -(-time.size // MOST)
    count = time.size // share
    if count < FEWEST:
        return None
    rest, corner, rounded = (
        _nearest(one, time, way) for one in (_rest, _corner, _round)
    )
    least = min(one.misfit for one in (rest, corner, rounded))
    if least > (time.size + FOREIGN * count) * variance:
        return None
    most = least + 2 * RARE * variance
    turns = (rest, rest.ends), (corner, corner.turns), (rounded, trend)
    likely = [when for one, when in turns if one.misfit <= most]
    within = share * float(np.diff(time).max()) / (FINE - 1)
    return Turn(min(likely) - within, max(likely) + within)


def _rest(time: Array, begins: Array, ends: Array) -> Ways:
    """Of steady speeds, with a rest between them."""
    return Ways(np.maximum(begins - time, 0.0), np.maximum(time - ends, 0.0))


def _corner(time: Array, begins: Array, ends: Array) -> Ways:
    """Of steady speeds, with a steady acceleration between them."""
    width = ends - begins
    twice = np.where(width > 0, 2 * width, np.inf)
    came, went = (np.clip(one, 0.0, width) for one in (ends - time, time - begins))
    rest = _rest(time, begins, ends)
    return Ways(rest.came + came**2 / twice, rest.went + went**2 / twice)


def _round(time: Array, begins: Array, ends: Array) -> Ways:
    """Of a steady acceleration each, amid the two."""
    middle = (begins + ends) / 2
    came, went = _rest(time, middle, middle)
    return Ways(came**2, went**2)


def _nearest(shape: Shape, time: Array, way: Array) -> _Bend:
    share = -(-time.size // MOST)
    rows = slice(time.size // share * share)
    t, y = (one[rows].reshape(-1, share).mean(1) for one in (time, way))
    first, last = _least(_misfit(shape, t, y, t, t))
    near = np.linspace(-1.0, 1.0, FINE) * np.diff(t).max()
    begins, ends = t[first] + near, t[last] + near
    misfit = _misfit(shape, time, way, begins, ends)
    first, last = _least(misfit)
    halted = misfit.halted[first, last] * (ends[last] - begins[first])
    squares = misfit.squares[first, last]
    return _Bend(float(ends[last]), float(begins[first] + halted), float(squares))


def _least(misfit: _Misfit) -> tuple[int, int]:
    first, last = divmod(int(np.argmin(misfit.squares)), misfit.squares.shape[1])
    return first, last


def _misfit(
    shape: Shape, time: Array, way: Array, begins: Array, ends: Array
) -> _Misfit:
    later = np.where(begins[:, None] <= ends, ends, np.nan)[..., None]
    came, went = shape(time, begins[:, None, None], later)
    came, went = (one - one.mean(axis=-1, keepdims=True) for one in (came, went))
    off = way - way.mean()
    one, other, both = (came**2).sum(-1), (went**2).sum(-1), (came * went).sum(-1)
    of_one, of_other = came @ off, went @ off
    with np.errstate(divide="ignore", invalid="ignore"):
        steep = (of_one * other - of_other * both) / (one * other - both**2)
        back = (of_other * one - of_one * both) / (one * other - both**2)
        squares = off @ off - (steep * of_one + back * of_other)
        halted = steep / (steep + back)
    return _Misfit(np.where(np.isfinite(squares), squares, np.inf), halted)
