"""Fingers that bend under the grip."""

import numpy as np
import pytest

from gripperd.effects.jaw_compliance import JawCompliance
from gripperd.model import Muscle
from tests.effects.tracks import track_of


def test_the_opening_is_wider_in_proportion_to_the_grip(muscle: Muscle) -> None:
    # 0.02 mm a newton.
    effect = JawCompliance(compliance=2e-5)
    track = track_of(muscle, grip=np.array([0.0, 25.0, 50.0]), force=300.0)
    found = effect.along(np.full(3, 0.040), track, effect.rest())
    assert found == pytest.approx([0.0400, 0.0405, 0.0410])


def test_pads_that_are_pressed_flat_give_less() -> None:
    """As stiff again with 50 N: 0.02 mm at first, and 0.01 mm a newton there."""
    pads = JawCompliance(compliance=2e-5, stiffening=0.02)
    loads = np.array([0.0, 1e-3, 50.0, 50.001])
    given = np.asarray(pads.widening(loads, 0.0))
    assert np.diff(given)[[0, 2]] == pytest.approx([2e-8, 1e-8], rel=1e-4)
    assert given[2] == pytest.approx(2e-5 / 0.02 * np.log(2))
    assert pads.stiffens
    assert not JawCompliance(compliance=2e-5).stiffens


@pytest.mark.parametrize("grip", [-3.0, np.nan])
def test_fingers_without_an_object_are_straight(muscle: Muscle, grip: float) -> None:
    effect = JawCompliance(compliance=2e-5)
    track = track_of(muscle, grip=grip, force=300.0)
    assert effect.along(np.array([0.040]), track, effect.rest()) == 0.040


def test_only_the_grip_bends_them() -> None:
    effect = JawCompliance(compliance=2e-5)
    assert effect.widening(50.0, 400.0) == pytest.approx(1e-3)
    assert effect.widening(0.0, 400.0) == 0.0
