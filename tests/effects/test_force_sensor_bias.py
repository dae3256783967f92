"""Zero error of the force sensor."""

import numpy as np
import pytest

from gripperd.effects.force_sensor_bias import ForceSensorBias
from gripperd.model import Muscle
from gripperd.model.effect import Signal
from tests.effects.tracks import track_of

TRUE = np.array([0.0, 100.0, 900.0])
READ = np.array([4.0, 104.0, 904.0])


def test_every_reading_is_off_by_the_same(muscle: Muscle) -> None:
    effect = ForceSensorBias(bias=4.0)
    track = track_of(muscle, force=TRUE)
    assert effect.along(TRUE, track, effect.rest()) == pytest.approx(READ)
    assert effect.truth(READ, track) == pytest.approx(TRUE)
    assert effect.signal is Signal.FORCE
