"""Relays in closed form, against a bank in which each is switched by itself."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from gripperd.model.memory import begin
from gripperd.model.preisach import Relays
from gripperd.model.track import Array

CENTRE, SPREAD = 0.1, 0.04
NARROW, WIDE = 0.01, 0.03
RELAYS = Relays(radius=NARROW, width=0.25, wide=0.6, centre=CENTRE, curve=1.0)
SHARES = (np.arange(4000) + 0.5) / 4000
MIDDLES = CENTRE + SPREAD * np.log(SHARES / (1 - SHARES))
"""Of equally many relays each: quantiles of the logistic distribution."""


def path(*turns: float) -> Array:
    """From one turning point to the next, in steps of 0.001."""
    legs = [
        np.linspace(start, end, 1 + round(abs(end - start) / 0.001))[1:]
        for start, end in pairwise(turns)
    ]
    return np.concatenate([[turns[0]], *legs])


def switched(signal: Array, half: float) -> Array:
    """Share of a bank that is up; none is within its band where the path begins."""
    up = np.zeros(MIDDLES.size, dtype=bool)
    shares = []
    for value in signal:
        up[value > MIDDLES + half] = True
        up[value < MIDDLES - half] = False
        shares.append(up.mean())
    return np.array(shares)


LONG = path(-0.5, 0.15, 0.06, 0.11, 0.09, 0.3, 0.0, 0.1)
THERE, BACK = path(-0.5, 0.7), path(0.7, -0.5)


def test_it_is_a_bank_of_relays() -> None:
    bank = 0.4 * switched(LONG, NARROW) + 0.6 * switched(LONG, WIDE)
    assert np.ptp(bank) > 0.9
    # All of them are down where the path begins.
    taken = RELAYS.up(LONG, begin(2))
    assert taken - taken[0] == pytest.approx(bank, abs=0.001)


def test_without_their_curve_only_the_memory_of_the_bank_is_left() -> None:
    there = switched(THERE, WIDE)
    back = switched(np.concatenate([THERE, BACK]), WIDE)[THERE.size :]
    middle = np.interp(LONG, THERE, 0.5 * (there + back[::-1]))
    memory = Relays(radius=WIDE, width=0.75, wide=0.0, centre=CENTRE, curve=0.0)
    expected = switched(LONG, WIDE) - middle
    assert np.ptp(expected) > 0.3
    assert memory.up(LONG, begin(2)) == pytest.approx(expected, abs=0.001)


@pytest.mark.parametrize("curve", [0.0, 0.3, 1.0])
@pytest.mark.parametrize("way", [1.0, -1.0])
def test_after_a_long_way_the_past_is_forgotten(way: float, curve: float) -> None:
    relays, end = replace(RELAYS, curve=curve), 0.1
    travelled = relays.up(path(end - way * 0.4, end), begin(2))[-1]
    assert relays.settled(end, way) == pytest.approx(travelled)


def test_the_loop_closes_at_the_ends_of_the_way() -> None:
    ends = np.array([-0.3, 0.1, 0.5])
    opened = np.asarray(RELAYS.settled(ends, -1.0) - RELAYS.settled(ends, 1.0))
    assert opened[1] > 0.2
    assert opened[[0, 2]] == pytest.approx(0.0, abs=0.001)


def test_the_curve_begins_where_the_signal_is_nothing() -> None:
    ways = [RELAYS.settled(0.0, way) for way in (1.0, -1.0)]
    assert ways[0] == pytest.approx(-np.asarray(ways[1]))
    assert ways[1] > 0.02


def test_sample_by_sample_it_is_the_same() -> None:
    memory = begin(2)
    pieces = [RELAYS.up(LONG[i : i + 1], memory) for i in range(LONG.size)]
    whole = RELAYS.up(LONG, begin(2))
    assert np.concatenate(pieces).tolist() == whole.tolist()
