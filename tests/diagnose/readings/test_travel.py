import numpy as np
import pytest

from gripperd.diagnose.noise.smoothing import Smooth
from gripperd.diagnose.readings.travel import contracting, leaning, travel


def test_travel_turns_where_it_turned_once_it_has_gone_far_enough() -> None:
    way = np.array([0.0, 2.0, 4.0, 3.5, 5.0, 6.0, 4.0, 2.0, 0.0])
    signs = travel(way, 1.0)
    np.testing.assert_array_equal(signs, [0, 1, 1, 1, 1, 1, -1, -1, -1])


def test_it_is_told_afterwards_that_it_had_turned() -> None:
    way = np.array([0.0, 1.0, 2.0, 3.0, 2.6, 2.2, 1.8, 1.4])
    np.testing.assert_array_equal(travel(way, 1.0), [0, 1, 1, 1, -1, -1, -1, -1])


def test_joints_lean_the_way_their_load_goes_and_stick_while_it_turns() -> None:
    # Of 100 N they stick within 6 N: half way through, friction is nil.
    load = np.array([0.0, 50.0, 100.0, 94.0, 88.0, 50.0, 56.0, 62.0])
    np.testing.assert_allclose(leaning(load), [0, 1, 1, 0, -1, -1, 0, 1])


def test_under_a_steady_load_joints_stick() -> None:
    load = 100.0 + np.tile([0.3, -0.3], 10)
    assert np.abs(leaning(load)).max() < 0.7


def test_joints_without_a_load_do_not_rub() -> None:
    np.testing.assert_array_equal(leaning(np.zeros(5)), 0.0)


def test_a_round_turn_is_where_the_way_is_longest() -> None:
    # 10 % there and back as a sine of 28 s, 25 samples a second.
    time = np.arange(0.0, 28.0, 0.04)
    way = 0.05 * (1 - np.cos(2 * np.pi * time / 28.0))
    turned = time[np.flatnonzero(np.diff(travel(way, 1.5e-3, 6e-4)) == -2)]
    np.testing.assert_allclose(turned, [14.0], atol=0.09)


def test_the_way_back_from_a_hold_begins_at_its_end_whatever_its_noise() -> None:
    there = np.linspace(0.0, 0.1, 100)
    hold = np.full(500, 0.1)
    hold[10] += 5e-4
    signs = travel(np.concatenate([there, hold, there[::-1]]), 1.5e-3, 6e-4)
    (turned,) = np.flatnonzero(np.diff(signs) == -2)
    assert abs(turned - 600) <= 5


@pytest.mark.parametrize("brief", [1, 2, 5, 9])
def test_a_trend_that_goes_too_far_at_an_object_does_not_turn_there(brief: int) -> None:
    there, held = np.linspace(0.0, 0.06, 60), np.full(200, 0.06)
    held[:brief] += 8e-4
    known = Smooth(np.concatenate([there, held, there[::-1]]), np.zeros(320))
    signs = contracting(known)
    (turned,) = np.flatnonzero(np.diff(signs) == -2)
    assert abs(turned - 260) <= 2


def test_what_rests_at_one_value_goes_nowhere() -> None:
    np.testing.assert_array_equal(travel(np.full(9, 3e5), 0.0), 0.0)


def test_from_a_corner_a_way_goes_straight() -> None:
    # 40 samples that rise by 1e-5 in all, then 1e-4 each: 15 of them are 1.5e-3.
    held, there = np.linspace(0.0, 1e-5, 40), np.linspace(0.0, 0.1, 1001)
    way = np.concatenate([held, 1e-5 + there[1:]])
    known = Smooth(way, np.zeros(way.size), variance=5e-4**2, broken=True)
    (begun,) = np.flatnonzero(np.diff(contracting(known)))
    assert abs(begun - 39) <= 1


def test_what_creeps_back_after_a_step_has_not_turned_before_it_is_seen() -> None:
    since = np.arange(400.0)
    creeping = 0.1 - 0.003 * (1 - np.exp(-since / 200.0))
    signs = travel(np.append([0.0, 0.03, 0.07], creeping), 1.5e-3, 3e-4)
    (turned,) = np.flatnonzero(np.diff(signs) == -2)
    # 3e-4 of 3e-3 are undone after 200 ln(10 / 9) = 21 samples.
    assert 3 + 21 - 4 <= turned <= 3 + 21


def test_the_first_way_begins_as_round_as_any() -> None:
    time = np.arange(0.0, 28.0, 0.04)
    way = 0.05 * (1 - np.cos(2 * np.pi * time / 28.0))
    assert np.argmax(travel(way, 1.5e-3, 6e-4)) <= 4


@pytest.mark.parametrize("off", [-2e-3, 2e-3])
def test_the_first_way_begins_where_the_rest_before_it_ends(off: float) -> None:
    way = np.concatenate([np.zeros(15), np.linspace(0.005, 0.1, 20)])
    way[:2] = off, off / 2
    (begun,) = np.flatnonzero(np.diff(travel(way, 2.9e-3, 1.2e-3)))
    assert abs(begun - 14) <= 1
