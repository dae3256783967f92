"""Zero error of the pressure transmitter."""

import numpy as np
import pytest

from gripperd.effects.pressure_sensor_bias import PressureSensorBias
from gripperd.model import Muscle
from gripperd.model.effect import Signal
from tests.effects.tracks import track_of

TRUE = np.array([0.0, 100e3, 400e3])
READ = np.array([-3e3, 97e3, 397e3])


def test_every_reading_is_off_by_the_same(muscle: Muscle) -> None:
    effect = PressureSensorBias(bias=-3e3)
    track = track_of(muscle, pressure=TRUE)
    assert effect.along(TRUE, track, effect.rest()) == pytest.approx(READ)
    assert effect.truth(READ, track) == pytest.approx(TRUE)
    assert effect.signal is Signal.PRESSURE
