"""Force against the rate of contraction."""

import numpy as np
import pytest

from gripperd.effects.viscous_friction import ViscousFriction
from gripperd.model import Muscle, StaticMuscle
from gripperd.model.track import Array
from tests.effects.tracks import track_of

RATES = np.array([-0.4, -0.1, 0.0, 0.1, 0.4])
ALL = ViscousFriction(damping=100.0, sublinear=10.0, pressure_damping=50.0)


def force(muscle: Muscle, effect: ViscousFriction, pressure: float = 0.0) -> Array:
    track = track_of(muscle, rate=RATES, pressure=pressure)
    return effect.along(np.zeros_like(RATES), track, effect.rest())


def test_nothing_rubs_when_still(muscle: Muscle) -> None:
    assert force(muscle, ALL, 4e5)[2] == 0.0
    assert StaticMuscle(muscle, (ALL,)).force(0.0, 0.1) == 0.0


def test_damping_grows_with_the_rate(muscle: Muscle) -> None:
    damping = ViscousFriction(damping=100.0)
    assert force(muscle, damping) == pytest.approx([40.0, 10.0, 0.0, -10.0, -40.0])
    assert force(muscle, damping, 4e5) == pytest.approx(force(muscle, damping))


def test_the_sublinear_part_grows_with_the_area_sine_of_the_rate(
    muscle: Muscle,
) -> None:
    # sinh 1, 2, 3 and 4 are 1.17520, 3.62686, 10.01787 and 27.28992.
    flowing = ViscousFriction(sublinear=30.0, flow=0.1 / 10.01787)
    rates = flowing.flow * np.array([-27.28992, -1.17520, 0.0, 3.62686, 10.01787])
    track = track_of(muscle, rate=rates)
    found = flowing.along(np.zeros(5), track, flowing.rest())
    assert found == pytest.approx([40.0, 10.0, 0.0, -20.0, -30.0], abs=1e-4)


def test_pressure_damping_is_proportional_to_pressure(muscle: Muscle) -> None:
    pressed = ViscousFriction(pressure_damping=100.0)
    assert force(muscle, pressed) == pytest.approx(0.0)
    expected = [80.0, 20.0, 0.0, -20.0, -80.0]
    assert force(muscle, pressed, 600e3) == pytest.approx(expected)


def test_a_muscle_under_vacuum_is_not_driven_by_its_damping(muscle: Muscle) -> None:
    """Nothing is between the strands: work would come from nowhere."""
    effect = ViscousFriction(pressure_damping=500.0)
    track = track_of(muscle, pressure=-5e3, rate=np.array([0.1, -0.1]))
    assert effect.along(np.zeros(2), track, effect.rest()) == pytest.approx(0.0)
