"""The regulator's line, turned about its low end."""

import numpy as np
import pytest

from gripperd.effects.valve_gain import ValveGain
from gripperd.model import Muscle
from tests.effects.tracks import track_of


def test_a_span_error_grows_along_the_line(muscle: Muscle) -> None:
    asked = np.array([0.0, 100e3, 500e3])
    effect = ValveGain(error=0.02)
    found = effect.along(asked, track_of(muscle, command=asked), effect.rest())
    assert found == pytest.approx([0.0, 102e3, 510e3])


def test_the_low_end_stays_where_it_is() -> None:
    # A line from 50 to 450 kPa, a tenth too steep.
    effect, span = ValveGain(error=0.1), (50e3, 450e3)
    assert effect.settled(50e3, span) == 50e3
    assert effect.settled(450e3, span) == pytest.approx(490e3)
