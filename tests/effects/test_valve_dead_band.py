"""A regulator that does not follow small reversals."""

import numpy as np
import pytest

from gripperd.effects.valve_dead_band import Spool, ValveDeadBand
from gripperd.model import Muscle
from gripperd.model.track import Array
from tests.effects.tracks import track_of

WIDTH = 4e3


def behind(asked: Array, muscle: Muscle, *, step: float = 0.1) -> Array:
    effect = ValveDeadBand(width=WIDTH)
    return effect.along(
        asked, track_of(muscle, command=asked, step=step), effect.rest()
    )


def test_reversals_within_the_width_are_not_followed(muscle: Muscle) -> None:
    asked = np.array([0.0, 100e3, 97e3, 99e3, 96.5e3, 100e3])
    assert behind(asked, muscle)[1:] == pytest.approx(98e3)


def test_up_and_down_differ_by_the_width(muscle: Muscle) -> None:
    up = np.arange(0.0, 201e3, 1e3)
    found = behind(np.concatenate([up, up[::-1]]), muscle)
    rising, falling = found[: up.size], found[up.size :][::-1]
    assert (falling - rising)[10:-10] == pytest.approx(WIDTH)


def test_speed_makes_no_difference(muscle: Muscle) -> None:
    asked = np.array([0.0, 100e3, 50e3, 80e3])
    slow, fast = (behind(asked, muscle, step=step) for step in (10.0, 1e-3))
    assert slow.tolist() == fast.tolist()


def test_a_steady_pressure_is_taken_in_the_middle_of_the_band() -> None:
    assert ValveDeadBand(width=WIDTH).settled(200e3, (0.0, 500e3)) == 200e3


UP_DOWN = np.r_[np.arange(0.0, 101e3, 1e3), np.arange(99e3, -1e3, -1e3)]


def _stuck(asked: Array, muscle: Muscle, known: Array | float = np.nan) -> Array:
    effect = ValveDeadBand(width=WIDTH, spool=Spool.STICKS)
    track = track_of(muscle, command=asked, pressure=known)
    return effect.along(asked, track, effect.rest())


def test_a_spool_that_sticks_lets_go_a_width_behind_and_is_late_no_more(
    muscle: Muscle,
) -> None:
    found = _stuck(UP_DOWN, muscle)
    assert found[:5].tolist() == [0.0] * 5
    assert found[5:101].tolist() == UP_DOWN[5:101].tolist()
    assert found[101:105].tolist() == [100e3] * 4
    assert found[105:].tolist() == UP_DOWN[105:].tolist()


def test_how_it_began_is_taken_from_the_pressure_that_was_measured(
    muscle: Muscle,
) -> None:
    assert _stuck(UP_DOWN, muscle, UP_DOWN)[:5].tolist() == UP_DOWN[:5].tolist()
    waited = np.where(UP_DOWN > WIDTH, UP_DOWN, 300.0)
    assert _stuck(UP_DOWN, muscle, waited)[:5].tolist() == [300.0] * 5


def test_two_spools_that_trail_leave_the_band_one_after_the_other(
    muscle: Muscle,
) -> None:
    """Of bands of 2 and 6 kPa, in parallel: half as far between, then as far."""
    effect = ValveDeadBand(width=WIDTH, spread=0.5)
    track = track_of(muscle, command=UP_DOWN, pressure=UP_DOWN)
    found = effect.along(UP_DOWN, track, effect.rest())
    assert found[10:101] == pytest.approx(UP_DOWN[10:101] - WIDTH / 2)
    back = [98e3, 98e3, 98e3, 97.5e3, 97e3, 96.5e3, 96e3, 95e3, 94e3]
    assert found[100:109] == pytest.approx(back)


def test_one_that_wakes_rests_where_the_command_does_not_turn(muscle: Muscle) -> None:
    asked = 1e3 * np.repeat([0, 50, 53, 56, 53, 50], 20)
    effect = ValveDeadBand(width=WIDTH, spool=Spool.WAKES, short=0.02, speed=50e3)
    track = track_of(muscle, command=asked, pressure=0 * asked)
    found = effect.along(asked, track, effect.rest())[19::20]
    assert found == pytest.approx(1e3 * np.array([0, 50, 50, 56, 56, 50]), abs=100)


def test_one_that_wakes_begins_where_the_pressure_is(muscle: Muscle) -> None:
    asked = np.full(30, 50e3)
    effect = ValveDeadBand(width=WIDTH, spool=Spool.WAKES)
    for off in (-3e3, 3e3):
        track = track_of(muscle, command=asked, pressure=asked + off)
        assert (effect.along(asked, track, effect.rest()) == asked + off).all()


def test_one_that_wakes_begins_no_further_away_than_its_band(muscle: Muscle) -> None:
    asked = np.full(30, 50e3)
    effect = ValveDeadBand(width=WIDTH, spool=Spool.WAKES)
    for off in (-2 * WIDTH, 2 * WIDTH):
        track = track_of(muscle, command=asked, step=0.0, pressure=asked + off)
        found = effect.along(asked, track, effect.rest())
        assert np.abs(found - asked).max() <= WIDTH


@pytest.mark.parametrize(
    ("spool", "width", "name"),
    [
        (Spool.WAKES, 4.9e3, "valve_lag"),
        (Spool.WAKES, 5.1e3, ""),
        (Spool.TRAILS, 4.9e3, ""),
        (Spool.STICKS, 4.9e3, ""),
    ],
)
def test_a_band_within_1_percent_that_only_makes_it_late_is_a_lag(
    spool: Spool, width: float, name: str
) -> None:
    assert ValveDeadBand(width=width, spool=spool).becomes == name
