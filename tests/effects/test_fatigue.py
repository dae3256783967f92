"""Force lost with the number of inflations."""

import numpy as np
import pytest

from gripperd.effects.fatigue import Fatigue
from gripperd.model import Muscle, StaticMuscle
from gripperd.model.track import Array
from tests.effects.tracks import track_of

CYCLES = np.array([0.0, 5.0, 10.0, 100.0])


def pull(muscle: Muscle, effect: Fatigue, fresh: float, time: float = 0.0) -> Array:
    track = track_of(muscle, cycle=CYCLES, time=time + np.arange(4.0))
    return effect.along(np.full(4, fresh), track, effect.rest())


def test_the_pull_is_scaled_down_with_every_inflation(muscle: Muscle) -> None:
    worn = Fatigue(loss=0.002)
    assert pull(muscle, worn, 500.0) == pytest.approx([500, 495, 490, 400])
    assert pull(muscle, worn, 50.0) == pytest.approx([50, 49.5, 49, 40])


def test_an_early_loss_comes_in_the_first_inflations(muscle: Muscle) -> None:
    worn = Fatigue(early_loss=0.1)
    # 1 - 1/e after five of them, 1 - 1/e² after ten, all after a hundred.
    expected = [500, 500 - 31.606028, 500 - 43.233236, 450]
    assert pull(muscle, worn, 500.0) == pytest.approx(expected)


def test_the_clock_does_not_matter(muscle: Muscle) -> None:
    worn = Fatigue(0.002, 0.1)
    later = pull(muscle, worn, 500.0, time=3600.0)
    assert later.tolist() == pull(muscle, worn, 500.0).tolist()


def test_a_prediction_is_that_of_the_fresh_muscle(muscle: Muscle) -> None:
    worn = StaticMuscle(muscle, (Fatigue(0.002, 0.1),))
    assert worn.force(3e5, 0.1) == StaticMuscle(muscle).force(3e5, 0.1)


def test_it_follows_a_loss_with_the_logarithm_of_the_cycles(muscle: Muscle) -> None:
    cycles = np.arange(40.0)
    track = track_of(muscle, cycle=cycles)
    columns = np.stack(
        [
            effect.along(np.ones(40), track, effect.rest()) - 1
            for effect in (Fatigue(1.0), Fatigue(0.0, 1.0))
        ],
        axis=1,
    )
    law = -np.log1p(cycles)
    fitted, *_ = np.linalg.lstsq(columns, law)
    assert np.std(law - columns @ fitted) < 0.03 * np.abs(law).max()
