"""Span error of the force sensor."""

import numpy as np
import pytest

from gripperd.effects.force_sensor_gain import ForceSensorGain
from gripperd.model import Muscle
from gripperd.model.effect import Signal
from tests.effects.tracks import track_of

TRUE = np.array([0.0, 100.0, 900.0])
READ = np.array([0.0, 99.0, 891.0])


def test_readings_are_off_in_proportion(muscle: Muscle) -> None:
    effect = ForceSensorGain(error=-0.01)
    track = track_of(muscle, force=TRUE)
    assert effect.along(TRUE, track, effect.rest()) == pytest.approx(READ)
    assert effect.truth(READ, track) == pytest.approx(TRUE)
    assert effect.signal is Signal.FORCE
