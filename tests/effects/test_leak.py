"""Air lost between regulator and muscle."""

from math import exp

import numpy as np
import pytest

from gripperd.effects.leak import Leak
from gripperd.model import Muscle
from tests.effects.tracks import track_of


def test_a_shut_line_decays_with_its_rate(muscle: Muscle) -> None:
    effect = Leak(rate=1 / 66)
    still = np.array([0.0, 66.0, 132.0])
    found = effect.along(
        np.full(3, 300e3), track_of(muscle, still=still), effect.rest()
    )
    assert found == pytest.approx([300e3, 300e3 / exp(1), 300e3 / exp(2)])


def test_a_regulator_that_feeds_the_leak_droops_by_the_share(muscle: Muscle) -> None:
    effect = Leak(early=0.05)
    still = np.array([0.0, 10.0, 1000.0])
    found = effect.along(
        np.full(3, 100e3), track_of(muscle, still=still), effect.rest()
    )
    assert found == pytest.approx([100e3, 100e3 - 5e3 * (1 - exp(-1)), 95e3])


def test_a_vented_line_has_nothing_to_lose(muscle: Muscle) -> None:
    effect = Leak(rate=0.01, early=0.1)
    track = track_of(muscle, still=np.array([0.0, 100.0]))
    assert effect.along(np.zeros(2), track, effect.rest()).tolist() == [0.0, 0.0]


def test_a_prediction_is_of_the_moment_before_it_leaks() -> None:
    assert Leak(rate=0.01).settled(200e3, (0.0, 500e3)) == 200e3
