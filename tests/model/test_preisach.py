"""Relays in closed form, against a bank in which each is switched by itself."""

from itertools import pairwise

import numpy as np
import pytest

from gripperd.model.memory import begin
from gripperd.model.preisach import Relays
from gripperd.model.track import Array

CENTRE, SPREAD = 0.1, 0.04
NARROW, WIDE = 0.01, 0.03
RELAYS = Relays(radius=NARROW, centre=CENTRE, spread=SPREAD, level=0.0)
SHARES = (np.arange(4000) + 0.5) / 4000
MIDDLES = CENTRE + SPREAD * np.log(SHARES / (1 - SHARES))
"""Of equally many relays each: quantiles of the logistic distribution."""
FORCES = (6.0, 10.0)


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


def test_it_is_a_bank_of_relays() -> None:
    bank = FORCES[0] * switched(LONG, NARROW) + FORCES[1] * switched(LONG, WIDE)
    taken = RELAYS.taken(LONG, FORCES, begin(2))
    assert np.ptp(bank) > 14
    assert taken == pytest.approx(bank, abs=0.01)


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_after_a_long_way_the_past_is_forgotten(way: float) -> None:
    end = 0.1
    travelled = RELAYS.taken(path(end - way * 0.4, end), FORCES, begin(2))[-1]
    assert RELAYS.settled(end, way, FORCES) == pytest.approx(travelled)


def test_the_loop_closes_at_the_ends_of_the_way() -> None:
    there, back = (
        RELAYS.settled(np.array([-0.3, 0.1, 0.5]), way, FORCES) for way in (1.0, -1.0)
    )
    opened = np.asarray(back - there)
    assert opened[1] > 3
    assert opened[[0, 2]] == pytest.approx(0.0, abs=0.01)


def test_no_force_is_taken_where_as_many_are_up_as_the_level_says() -> None:
    half = Relays(radius=NARROW, centre=CENTRE, spread=SPREAD, level=0.5)
    assert half.taken(np.array([CENTRE]), FORCES, begin(2)) == pytest.approx([0.0])


def test_sample_by_sample_it_is_the_same() -> None:
    memory = begin(2)
    pieces = [RELAYS.taken(LONG[i : i + 1], FORCES, memory) for i in range(LONG.size)]
    whole = RELAYS.taken(LONG, FORCES, begin(2))
    assert np.concatenate(pieces).tolist() == whole.tolist()
