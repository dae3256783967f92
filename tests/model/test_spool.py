"""A spool that sticks, by hand: where the command goes, and where the spool stays."""

import numpy as np
import pytest

from gripperd.model.memory import begin
from gripperd.model.spool import slides, sticking
from gripperd.model.track import Array

BAND = 10.0


def _stuck(*command: float) -> list[float]:
    found = sticking(np.array(command), BAND, begin(3))
    return [float(one) for one in found]


def test_it_follows_without_a_gap_once_it_has_slipped() -> None:
    assert _stuck(0, 6, 10, 11, 15, 30) == [0, 0, 0, 11, 15, 30]


def test_it_sticks_where_the_command_turns_until_that_is_a_band_away() -> None:
    assert _stuck(0, 30, 26, 21, 20, 19, 5) == [0, 30, 30, 30, 30, 19, 5]


def test_it_goes_on_when_the_command_comes_back_to_where_it_stuck() -> None:
    assert _stuck(0, 30, 25, 30, 36, 41) == [0, 30, 30, 30, 30, 41]


def test_what_is_noise_of_a_command_does_not_turn_it() -> None:
    # A tenth of the band is no reversal.
    assert _stuck(0, 30, 29.5, 31, 30.2, 32) == [0, 30, 30, 31, 31, 32]


def test_a_command_may_come_piece_by_piece() -> None:
    command = 40 * np.sin(np.linspace(0.0, 12.0, 90)) + np.linspace(0.0, 20.0, 90)
    whole = sticking(command, BAND, begin(3))
    state = begin(3)
    pieces = [sticking(command[i : i + 7], BAND, state) for i in range(0, 90, 7)]
    assert np.concatenate(pieces).tolist() == whole.tolist()


def test_a_spool_that_slides_does_not_stick_first() -> None:
    state = np.array([0.0, 1.0, np.nan])
    assert sticking(np.array([0.0, 3.0, 7.0]), BAND, state).tolist() == [0, 3, 7]


RISING = np.linspace(0.0, 30.0, 61)


@pytest.mark.parametrize(
    ("followed", "way"),
    [
        (RISING, 1.0),
        (np.where(RISING > BAND, RISING, 0.0), 0.0),
        (0 * RISING, 0.0),
    ],
    ids=["as it goes", "from a band on", "never"],
)
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_how_a_spool_began_shows_within_the_first_band(
    followed: Array, way: float, sign: float
) -> None:
    waits = np.zeros(40)
    command, answer = (sign * np.r_[waits, one] for one in (RISING, followed))
    noise = np.random.default_rng(4).normal(0.0, 0.5, command.size)
    assert slides(command, answer + noise, BAND) == sign * way


def test_of_a_command_that_goes_nowhere_nothing_is_told() -> None:
    still = np.full(20, 7.0)
    assert slides(still, still, BAND) == 0.0
