"""A spool that sticks, by hand: where the command goes, and where the spool stays."""

import numpy as np
import pytest

from gripperd.model.memory import begin
from gripperd.model.spool import slides, sticking, waking
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


LEAP, REST = 1e-6, 60.0
"""Time of a command from one level to the next, and on it. [s]"""


def _woken(*levels: float, short: float = 0.01, speed: float = 5.0) -> list[float]:
    """Where a regulator rests on each level of a command."""
    command = np.repeat(levels, 2)
    step = np.tile([LEAP, REST], len(levels))
    found = waking(command, step, BAND, (short, speed), begin(3))[1::2]
    return [float(one) for one in found]


def test_a_regulator_that_wakes_rests_wherever_it_has_got_to() -> None:
    # One that sticks where its command turns would follow it to 39, too.
    levels, found = (
        (0.0, 30.0, 39.0, 35.0, 24.0, 18.0, 13.0),
        [0, 30, 30, 30, 30, 18, 18],
    )
    assert _woken(*levels) == pytest.approx(found, abs=0.1)


def test_it_goes_as_a_lag_whose_speed_a_band_away_is_told_until_it_is_close() -> None:
    """By hand: from 20 away 2 s to each fold, 4.2 s to a quarter of the band."""
    time = np.linspace(0.0, 12.0, 241)
    command, step = np.full(241, 20.0), np.full(241, 0.05)
    state = np.array([0.0, 0.0, 20.0])
    step[0] = 0.0
    found = waking(command, step, BAND, (0.25, 5.0), state)
    goes = time < 2.0 * np.log(20.0 / 2.5)
    assert found[goes] == pytest.approx(20 * (1 - np.exp(-time[goes] / 2.0)))
    assert found[~goes] == pytest.approx(17.5, abs=0.02)
    assert state[:2].tolist() == [found[-1], 0.0]


def test_on_a_ramp_it_goes_in_stairs_of_what_it_did_not_leave() -> None:
    time = np.linspace(0.0, 100.0, 2001)
    step = np.diff(time, prepend=0.0)
    found = waking(time, step, BAND, (0.2, 1e3), begin(3))
    stairs, counts = np.unique(np.round(found, 6), return_counts=True)
    rests = stairs[counts > 20]
    # It leaves 2 of 10, but goes on as it gets there, in some tenths of a second.
    assert np.diff(rests) == pytest.approx(8.25, abs=0.3)
    assert np.max(time - found) < BAND + 0.1


def test_without_a_band_it_is_where_its_command_is() -> None:
    command = 40 * np.sin(np.linspace(0.0, 12.0, 90))
    found = waking(command, np.full(90, 0.1), 0.0, (0.1, 20.0), begin(3))
    assert found == pytest.approx(command)


def test_a_regulator_that_wakes_may_be_told_piece_by_piece_and_not_at_all() -> None:
    command = 40 * np.sin(np.linspace(0.0, 12.0, 90)) + np.linspace(0.0, 20.0, 90)
    command[[0, 17, 40, 41]] = np.nan
    step, state = np.full(90, 0.1), begin(3)
    whole = waking(command, step, BAND, (0.1, 60.0), begin(3))
    pieces = [
        waking(command[i : i + 7], step[i : i + 7], BAND, (0.1, 60.0), state)
        for i in range(0, 90, 7)
    ]
    assert np.concatenate(pieces)[1:].tolist() == whole[1:].tolist()
    assert np.isfinite(whole[1:]).all()
