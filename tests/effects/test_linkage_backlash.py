"""Lost motion between muscle and jaws."""

import numpy as np
import pytest

from gripperd.effects.linkage_backlash import LinkageBacklash
from gripperd.model import Direction, Muscle
from tests.effects.tracks import track_of

WIDTH = 0.4e-3


def test_the_jaws_stand_still_until_the_play_is_taken_up(muscle: Muscle) -> None:
    effect = LinkageBacklash(width=WIDTH)
    told = 1e-3 * np.array([80.0, 70.0, 70.3, 70.4, 70.5, 75.0])
    found = effect.along(told, track_of(muscle, contraction=told), effect.rest())
    expected = 1e-3 * np.array([80.0, 70.2, 70.2, 70.2, 70.3, 74.8])
    assert found == pytest.approx(expected)


def test_nothing_of_it_stays_once_settled() -> None:
    effect = LinkageBacklash(width=WIDTH)
    assert effect.widening(50.0, 400.0) == 0.0
    assert effect.transmitted(50.0, Direction.CONTRACTING) == 50.0
