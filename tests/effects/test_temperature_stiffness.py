"""A modulus that follows the temperature."""

import numpy as np
import pytest

from gripperd.effects.temperature_stiffness import TemperatureStiffness
from gripperd.model import Muscle
from gripperd.model.track import Array
from tests.effects.tracks import track_of

# Eq. (5) at a contraction of 0.1.
RUBBER = 186.345782


def change(
    muscle: Muscle,
    effect: TemperatureStiffness,
    kelvin: float,
    contraction: float = 0.1,
) -> Array:
    track = track_of(muscle, temperature=kelvin, contraction=contraction)
    return effect.along(np.zeros(1), track, effect.rest())


def test_warm_rubber_that_stiffens_pulls_back_harder(muscle: Muscle) -> None:
    effect = TemperatureStiffness(modulus=0.005)
    assert change(muscle, effect, 303.15) == pytest.approx(-0.05 * RUBBER)
    assert change(muscle, effect, 283.15) == pytest.approx(0.05 * RUBBER)


def test_the_second_order_has_no_sign(muscle: Muscle) -> None:
    effect = TemperatureStiffness(modulus_square=2e-4)
    assert change(muscle, effect, 303.15) == pytest.approx(-0.02 * RUBBER)
    assert change(muscle, effect, 283.15) == pytest.approx(-0.02 * RUBBER)


def test_the_difference_vanishes_at_rest_length(muscle: Muscle) -> None:
    assert change(muscle, TemperatureStiffness(0.005), 313.15, 0.0) == 0.0


@pytest.mark.parametrize("kelvin", [293.15, np.nan])
def test_at_room_temperature_or_an_unknown_one_nothing_changes(
    muscle: Muscle, kelvin: float
) -> None:
    assert change(muscle, TemperatureStiffness(0.005, 2e-4), kelvin) == 0.0


def test_rubber_that_is_late_has_63_percent_after_its_time(muscle: Muscle) -> None:
    """A thermometer leaps by 10 K after a second; the wall takes 15 s."""
    time = np.arange(0.0, 91.0)
    kelvin = np.where(time < 1, 293.15, 303.15)
    track = track_of(
        muscle,
        time=time,
        step=np.diff(time, prepend=0.0),
        temperature=kelvin,
        contraction=0.1,
    )
    effect = TemperatureStiffness(modulus=0.005, late=15.0)
    pull = effect.along(np.zeros(time.size), track, effect.rest())
    assert pull[0] == 0.0
    assert pull[15] == pytest.approx(-0.05 * RUBBER * (1 - np.exp(-1)))
    assert pull[-1] == pytest.approx(-0.05 * RUBBER, rel=3e-3)


def test_it_follows_the_law_of_arrhenius(muscle: Muscle) -> None:
    """Over 20 K to a hundredth of its size, with 10 kJ/mol."""
    kelvin = np.linspace(288.15, 308.15, 21)
    track = track_of(muscle, temperature=kelvin, contraction=0.1)
    law = -RUBBER * (np.exp(10e3 / 8.314 * (1 / kelvin - 1 / 293.15)) - 1)
    columns = [
        effect.along(np.zeros(21), track, effect.rest())
        for effect in (TemperatureStiffness(1.0), TemperatureStiffness(0.0, 1.0))
    ]
    fitted, *_ = np.linalg.lstsq(np.stack(columns, 1), law)
    left = law - np.stack(columns, 1) @ fitted
    assert np.abs(left).max() < 0.01 * np.abs(law).max()
