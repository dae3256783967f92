from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.correction.gaussian_process import Kernel, Process
from gripperd.diagnose.correction.offer import Correction
from gripperd.diagnose.correction.table import maps
from gripperd.diagnose.readings.columns import BY_QUANTITY
from gripperd.diagnose.residuals.regressors import DIRECTION
from gripperd.model.effect import Signal
from gripperd.model.track import Array
from tests.diagnose.offered import bump


def _moving(lengths: Array) -> Correction:
    """Of pressure, contraction and direction: 10 N against the travel."""
    kernel = Kernel(10.0, lengths)
    places = np.array([-1.0, 0.0, 1.0])
    centres = np.array([[p, h, d] for p in places for h in places for d in (-1.0, 1.0)])
    features = kernel.between(centres, centres) / 0.1
    process = Process.given(kernel, centres, features, -10.0 * centres[:, 2] / 0.1)
    return Correction(
        signal=Signal.FORCE,
        regressors=(BY_QUANTITY["pressure"], BY_QUANTITY["contraction"], DIRECTION),
        process=process,
        usual=np.array([200e3, 0.1, 0.0]),
        spread=np.array([200e3, 0.1, 1.0]),
        ends=np.array([[0.0, 0.0, -1.0], [400e3, 0.2, 1.0]]),
        held={},
        wander=1.0,
    )


def test_what_depends_on_one_quantity_is_a_row() -> None:
    (drawn,) = maps(bump().correction, 5)
    assert [axis.quantity for axis in drawn.axes] == ["pressure"]
    assert drawn.values.shape == drawn.places[0].shape
    assert drawn.places[0][[0, -1]].tolist() == [0.0, 400e3]


def test_places_lie_close_enough_for_straight_lines_between_them() -> None:
    (drawn,) = maps(bump().correction, 5)
    assert np.diff(drawn.places[0]).max() <= 25e3
    (coarse,) = maps(bump().correction, 40)
    assert coarse.places[0].size == 40


def test_the_fence_is_where_half_of_the_variance_is_left() -> None:
    (drawn,) = maps(bump().correction, 60)
    # One exact reading leaves 1 - exp(-(d/l)²) of it, half at 0.83 lengths of 50 kPa.
    inside = drawn.places[0][np.isfinite(drawn.values)]
    reach = 50e3 * np.sqrt(np.log(2))
    assert np.abs(inside - 200e3).max() == pytest.approx(reach, abs=7e3)


def test_each_value_has_its_standard_deviation() -> None:
    (drawn,) = maps(bump().correction, 60)
    inside = np.isfinite(drawn.values)
    assert np.isnan(drawn.stds[~inside]).all()
    # The same reading again: a prior of 40 N, known by exp(-(d/l)²) of its variance.
    known = np.exp(-np.square((drawn.places[0][inside] - 200e3) / 50e3))
    assert drawn.stds[inside] == pytest.approx(40.0 * np.sqrt(1 - known), abs=0.2)


def test_where_the_direction_matters_both_ways_are_drawn() -> None:
    up, down = maps(_moving(np.array([1.0, 2.0, 1.0])), 5)
    assert [axis.quantity for axis in up.axes] == ["pressure", "contraction"]
    assert (up.held[DIRECTION], down.held[DIRECTION]) == (1.0, -1.0)
    assert up.values == pytest.approx(np.full_like(up.values, -10.0), abs=1.5)
    assert down.values == pytest.approx(-up.values, abs=0.1)


def test_where_it_does_not_one_map_is_enough() -> None:
    (drawn,) = maps(_moving(np.array([1.0, 2.0, 30.0])), 5)
    assert drawn.held == {}


def test_the_quantity_it_changes_fastest_along_comes_first() -> None:
    (drawn,) = maps(_moving(np.array([2.0, 1.0, 30.0])), 5)
    assert [axis.quantity for axis in drawn.axes] == ["contraction", "pressure"]


def test_nothing_is_drawn_beyond_the_ends() -> None:
    correction = bump().correction
    narrow = replace(correction, ends=np.array([[190e3, 0.0], [210e3, 0.2]]))
    (drawn,) = maps(narrow, 5)
    assert drawn.places[0][[0, -1]].tolist() == [190e3, 210e3]
