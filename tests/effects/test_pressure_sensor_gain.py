"""Span error of the pressure transmitter."""

import numpy as np
import pytest

from gripperd.effects.pressure_sensor_gain import PressureSensorGain
from gripperd.model import Muscle
from gripperd.model.effect import Signal
from tests.effects.tracks import track_of

TRUE = np.array([0.0, 100e3, 400e3])
READ = np.array([0.0, 102e3, 408e3])


def test_readings_are_off_in_proportion(muscle: Muscle) -> None:
    effect = PressureSensorGain(error=0.02)
    track = track_of(muscle, pressure=TRUE)
    assert effect.along(TRUE, track, effect.rest()) == pytest.approx(READ)
    assert effect.truth(READ, track) == pytest.approx(TRUE)
    assert effect.signal is Signal.PRESSURE
