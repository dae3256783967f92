"""Which legs of a travel the readings bear out."""

import numpy as np

from gripperd.diagnose.readings.cutting import courses
from gripperd.diagnose.readings.legs import borne_out
from gripperd.diagnose.readings.recording import Recording
from gripperd.model.track import Array
from tests.diagnose.sweep import run

NOISE = 7e-4
DOWN = np.linspace(0.17, 0.015, 78)
CORNER = DOWN.size - 1


def _read(*ways: Array, seed: int = 0) -> Array:
    way = np.concatenate(ways)
    return way + np.random.default_rng(seed).normal(0.0, NOISE, way.size)


def _signs(size: int, *turns: int) -> Array:
    """Down first, turning round at each of some samples."""
    signs = -np.ones(size)
    for turn in turns:
        signs[turn:] *= -1
    return signs


def test_a_rest_after_a_corner_is_no_way_back() -> None:
    way = _read(DOWN, np.full(10, 0.015))
    way[CORNER] -= 3 * NOISE
    told = borne_out(_signs(way.size, CORNER + 1), way, NOISE**2)
    assert told.tolist() == _signs(way.size).tolist()


def test_a_short_way_back_of_three_sigma_is_one() -> None:
    back = np.full(10, DOWN[-1] + 3 * NOISE)
    way = _read(DOWN, np.full(10, DOWN[-1]), back)
    signs = _signs(way.size, CORNER + 11)
    assert borne_out(signs, way, NOISE**2).tolist() == signs.tolist()


def test_noise_on_the_way_splits_no_leg() -> None:
    way = _read(DOWN, DOWN[::-1])
    way[40:42] += 2.5 * NOISE
    told = borne_out(_signs(way.size, 40, 42, CORNER + 1), way, NOISE**2)
    assert told.tolist() == _signs(way.size, CORNER + 1).tolist()


def test_a_first_leg_that_noise_alone_makes_is_no_travel_yet() -> None:
    still = np.zeros(20)
    way = _read(still, np.full(5, -1.5 * NOISE), DOWN[::-1])
    signs = np.concatenate([still, np.full(5, -1.0), np.ones(DOWN.size)])
    told = borne_out(signs, way, NOISE**2)
    assert told.tolist() == [*25 * [0.0], *DOWN.size * [1.0]]


def test_a_leap_before_a_first_leg_is_a_travel() -> None:
    still = np.zeros(20)
    way = _read(still, np.full(30, 0.17), DOWN)
    signs = np.concatenate([still, np.ones(30), -np.ones(DOWN.size)])
    told = borne_out(signs, way, NOISE**2)
    assert told[20:].tolist() == (-np.ones(30 + DOWN.size)).tolist()


def test_before_any_travel_there_is_no_leg_to_take_back() -> None:
    way = _read(np.full(9, 0.17), DOWN)
    signs = np.concatenate([np.zeros(9), _signs(DOWN.size)])
    assert borne_out(signs, way, NOISE**2).tolist() == signs.tolist()


def test_what_was_not_read_tells_nothing() -> None:
    way = _read(DOWN, np.full(10, 0.015))
    way[CORNER - 3 :] = np.nan
    told = borne_out(_signs(way.size, CORNER + 1), way, NOISE**2)
    assert told.tolist() == _signs(way.size).tolist()


def test_a_cycle_that_ends_at_rest_ends_as_it_went() -> None:
    way = _read(DOWN[::-1], DOWN[1:], np.full(10, DOWN[-1]))
    corner = way.size - 11
    # As read by a tester of grippers: low at the corner, and a little high after.
    way[corner : corner + 10] += NOISE * np.array([-3, -1, -0.5, 0, 1, 1, 1, 0.5, 1, 1])
    clock = np.linspace(0.0, 0.1 * (way.size - 1), way.size)
    cycle = run("c", time=clock, pressure=np.full(way.size, 3e5), contraction=way)
    (course,), _ = courses(Recording("c", "", (cycle,)), 0.25)
    travelled = course.direction[course.direction != 0]
    assert np.count_nonzero(np.diff(travelled)) == 1
    assert travelled[-1] == -1
