"""Air lost between regulator and muscle."""

from math import exp

import numpy as np
import pytest

from gripperd.effects.leak import Leak
from gripperd.model import Muscle
from gripperd.model.track import Array
from tests.effects.tracks import track_of


def _left(effect: Leak, muscle: Muscle, pressure: list[float], **moved: Array) -> Array:
    track = track_of(muscle, **({"waiting": moved["still"]} | moved))
    return effect.along(np.array(pressure), track, effect.rest())


def test_a_shut_line_decays_with_its_rate(muscle: Muscle) -> None:
    still = np.array([0.0, 66.0, 132.0])
    step = np.array([0.0, 66.0, 66.0])
    found = _left(Leak(rate=1 / 66), muscle, 3 * [300e3], still=still, step=step)
    assert found == pytest.approx([300e3, 300e3 / exp(1), 300e3 / exp(2)])


@pytest.mark.parametrize(
    ("refill", "kept"), [(0.02, 0.0), (0.1, exp(-1)), (10.0, 0.99)]
)
def test_what_was_lost_is_filled_up_as_fast_as_the_regulator_fills(
    muscle: Muscle, refill: float, kept: float
) -> None:
    # Half a minute at 400 kPa, then told 200 kPa within a tenth of a second.
    still, step = np.array([0.0, 30.0, 0.0]), np.array([0.0, 30.0, 0.1])
    effect = Leak(rate=1e-3, refill=refill)
    found = _left(effect, muscle, [400e3, 400e3, 200e3], still=still, step=step)
    lost = 400e3 * (1 - exp(-0.03))
    assert found[1] == pytest.approx(400e3 - lost)
    assert found[2] == pytest.approx(200e3 - kept * lost, abs=100.0)


def test_what_a_regulator_keeps_is_not_lost(muscle: Muscle) -> None:
    still, waiting = np.array([0.0, 30.0, 60.0]), np.array([0.0, 30.0, 0.0])
    step = np.array([0.0, 30.0, 30.0])
    effect = Leak(rate=1e-3)
    moved = {"still": still, "waiting": waiting, "step": step}
    found = _left(effect, muscle, 3 * [400e3], **moved)
    assert found == pytest.approx([400e3, 400e3 * exp(-0.03), 400e3], abs=1.0)


def test_no_more_is_lost_than_there_is(muscle: Muscle) -> None:
    still, step = np.array([0.0, 100.0, 0.0]), np.array([0.0, 100.0, 0.1])
    effect = Leak(rate=0.1, refill=30.0)
    found = _left(effect, muscle, [400e3, 400e3, 0.0], still=still, step=step)
    assert found[2] == 0.0


def test_a_regulator_that_feeds_the_leak_droops_by_the_share(muscle: Muscle) -> None:
    effect = Leak(early=0.05)
    still = np.array([0.0, 10.0, 1000.0])
    found = effect.along(
        np.full(3, 100e3), track_of(muscle, still=still), effect.rest()
    )
    assert found == pytest.approx([100e3, 100e3 - 5e3 * (1 - exp(-1)), 95e3])


def test_a_vented_line_has_nothing_to_lose(muscle: Muscle) -> None:
    effect = Leak(rate=0.01, early=0.1)
    still = np.array([0.0, 100.0])
    track = track_of(muscle, still=still, waiting=still)
    assert effect.along(np.zeros(2), track, effect.rest()).tolist() == [0.0, 0.0]


def test_a_prediction_is_of_the_moment_before_it_leaks() -> None:
    assert Leak(rate=0.01).settled(200e3, (0.0, 500e3)) == 200e3
