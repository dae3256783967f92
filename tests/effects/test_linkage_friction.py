"""Joints that rub in proportion to the load."""

import numpy as np
import pytest

from gripperd.effects.linkage_friction import LinkageFriction
from gripperd.model import Direction, Muscle
from tests.effects.tracks import track_of


def test_grip_is_lost_closing_and_won_opening(muscle: Muscle) -> None:
    effect = LinkageFriction(loss=0.1)
    track = track_of(muscle, direction=np.array([1.0, 1.0, -1.0, -1.0]))
    found = effect.along(np.array([0.0, 50.0, 50.0, 20.0]), track, effect.rest())
    assert found == pytest.approx([0.0, 45.0, 55.0, 22.0])


def test_a_settled_grip_keeps_the_loss_of_the_last_travel() -> None:
    effect = LinkageFriction(loss=0.1)
    assert effect.transmitted(50.0, Direction.CONTRACTING) == pytest.approx(45.0)
    assert effect.widening(50.0, 400.0) == 0.0
