"""An absolute transducer less a constant, in changing weather."""

import numpy as np
import pytest

from gripperd.effects.ambient_pressure import AmbientPressure
from gripperd.model import Muscle
from tests.effects.tracks import track_of

AMBIENT = np.array([101.325e3, 98.0e3, 84.5e3])
"""By the sea, in a storm, and at 1500 m. [Pa]"""
GAUGE = np.full(3, 200e3)


def test_an_absolute_transducer_less_a_tenth_of_a_megapascal(muscle: Muscle) -> None:
    effect = AmbientPressure(share=1.0, zero=1.325e3)
    read = GAUGE + AMBIENT - 100e3
    track = track_of(muscle, pressure=GAUGE, ambient=AMBIENT)
    assert effect.along(GAUGE, track, effect.rest()) == pytest.approx(read)
    assert effect.truth(read, track) == pytest.approx(GAUGE)


def test_in_the_standard_atmosphere_only_the_zero_is_left(muscle: Muscle) -> None:
    effect = AmbientPressure(share=1.0, zero=-500.0)
    track = track_of(muscle, ambient=np.array([101_325.0]))
    assert effect.along(np.zeros(1), track, effect.rest()) == -500.0


def test_where_the_air_is_not_measured_it_is_the_standard_atmosphere(
    muscle: Muscle,
) -> None:
    effect = AmbientPressure(share=1.0, zero=300.0)
    track = track_of(muscle, ambient=np.array([np.nan, 100_325.0]))
    reading = effect.along(np.full(2, 200e3), track, effect.rest())
    np.testing.assert_allclose(reading, [200_300.0, 199_300.0])
