"""The regulator's line, shifted."""

import numpy as np
import pytest

from gripperd.effects.valve_offset import ValveOffset
from gripperd.model import Muscle
from tests.effects.tracks import track_of

SPAN = (0.0, 500e3)


def test_the_whole_line_is_shifted_by_as_much(muscle: Muscle) -> None:
    effect = ValveOffset(offset=-5e3)
    asked = np.array([0.0, 100e3, 500e3])
    found = effect.along(asked, track_of(muscle, command=asked), effect.rest())
    assert found == pytest.approx([-5e3, 95e3, 495e3])


def test_a_steady_pressure_is_shifted_too() -> None:
    assert ValveOffset(offset=3e3).settled(200e3, SPAN) == 203e3
