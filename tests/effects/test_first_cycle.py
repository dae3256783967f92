"""First inflation after a rest."""

import numpy as np
import pytest

from gripperd.effects.first_cycle import FirstCycle
from gripperd.model import Muscle, StaticMuscle
from gripperd.model.track import Array
from tests.effects.tracks import track_of

CYCLE = np.array([0.0, 0.0, 1.0, 2.0, 3.0, 4.0, 5.0])
# A sweep on its own, then two rows of repeats.
REPEAT = np.array([np.nan, np.nan, 0.0, 1.0, 2.0, 0.0, 1.0])


def pull(muscle: Muscle, effect: FirstCycle) -> Array:
    track = track_of(muscle, cycle=CYCLE, repeat=REPEAT)
    return effect.along(np.full(7, 200.0), track, effect.rest())


def test_only_the_first_inflation_of_the_recording_differs(muscle: Muscle) -> None:
    expected = [235.0, 235.0, 200.0, 200.0, 200.0, 200.0, 200.0]
    assert pull(muscle, FirstCycle(0.15, 5.0)) == pytest.approx(expected)


def test_after_a_rest_the_first_sweep_of_every_row_differs(muscle: Muscle) -> None:
    expected = [200.0, 200.0, 235.0, 200.0, 200.0, 235.0, 200.0]
    assert pull(muscle, FirstCycle(0.15, 5.0, after=1.0)) == pytest.approx(expected)


def test_a_partial_recovery_stands_between_them(muscle: Muscle) -> None:
    half = pull(muscle, FirstCycle(0.15, 5.0, after=0.5))
    ends = [pull(muscle, FirstCycle(0.15, 5.0, after=after)) for after in (0.0, 1.0)]
    assert half == pytest.approx((ends[0] + ends[1]) / 2)


def test_rubber_that_has_been_at_a_pressure_is_soft_there(muscle: Muscle) -> None:
    pressure = np.array([1e5, 3e5, 5e5, 4.75e5, 4e5, 3e5, 1e5])
    track = track_of(muscle, pressure=pressure, cycle=0.0)
    effect = FirstCycle(0.15, 5.0, softened=2.0)
    found = effect.along(np.full(7, 200.0), track, effect.rest())
    expected = [235.0, 235.0, 235.0, 217.5, 200.0, 200.0, 200.0]
    assert found == pytest.approx(expected)


def test_rubber_that_has_been_at_a_length_is_soft_there(muscle: Muscle) -> None:
    contraction = np.array([0.0, 0.05, 0.1, 0.098, 0.095, 0.05, 0.11])
    track = track_of(muscle, pressure=3e5, contraction=contraction, cycle=0.0)
    effect = FirstCycle(0.15, 5.0, eased=2.0)
    found = effect.along(np.full(7, 200.0), track, effect.rest())
    expected = [235.0, 235.0, 235.0, 221.0, 200.0, 200.0, 235.0]
    assert found == pytest.approx(expected)
    memory = effect.rest()
    for one, known in zip(contraction.tolist(), expected, strict=True):
        track = track_of(muscle, pressure=3e5, contraction=one, cycle=0.0)
        assert effect.along(np.full(1, 200.0), track, memory) == pytest.approx(known)


def test_where_it_was_most_strained_virgin_rubber_is_as_soft_as_any(
    muscle: Muscle,
) -> None:
    pressure = np.array([0.0, 1e5, 2.5e5, 4e5, 5e5, 6e5, 1e5])
    track = track_of(muscle, pressure=pressure, cycle=0.0)
    effect = FirstCycle(0.3, growth=-0.05)
    found = effect.along(np.full(7, 200.0), track, effect.rest())
    expected = [260.0, 250.0, 235.0, 220.0, 210.0, 200.0, 200.0]
    assert found == pytest.approx(expected)


def test_a_prediction_is_that_of_a_muscle_inflated_before(muscle: Muscle) -> None:
    static = StaticMuscle(muscle, (FirstCycle(0.15, 5.0),))
    assert static.force(3e5, 0.1) == StaticMuscle(muscle).force(3e5, 0.1)
