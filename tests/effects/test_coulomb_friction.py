"""Dry friction of constant size."""

import numpy as np
import pytest

from gripperd.effects.coulomb_friction import CoulombFriction
from gripperd.model import Direction, Muscle, StaticMuscle
from tests.effects.tracks import track_of


@pytest.mark.parametrize("pressure", [0.0, 2e5, 6e5])
@pytest.mark.parametrize("contraction", [0.0, 0.1, 0.2])
def test_the_loop_has_the_same_width_everywhere(
    muscle: Muscle, pressure: float, contraction: float
) -> None:
    static = StaticMuscle(muscle, (CoulombFriction(15.0),))
    contracting = static.force(pressure, contraction, Direction.CONTRACTING)
    extending = static.force(pressure, contraction, Direction.EXTENDING)
    assert extending - contracting == pytest.approx(30.0)
    ideal = StaticMuscle(muscle).force(pressure, contraction)
    assert ideal - contracting == pytest.approx(15.0)


def test_the_force_jumps_where_the_travel_turns(muscle: Muscle) -> None:
    friction = CoulombFriction(15.0)
    track = track_of(muscle, direction=np.array([1.0, 1.0, -1.0, -1.0, 1.0]))
    force = friction.along(np.zeros(5), track, friction.rest())
    assert force.tolist() == [-15.0, -15.0, 15.0, 15.0, -15.0]


def test_after_a_reversal_it_turns_round_within_its_distance(muscle: Muscle) -> None:
    friction = CoulombFriction(15.0, distance=1e-3)
    contraction = np.array([0.1, 0.099, 0.098, 0.09])
    direction = np.array([1.0, -1.0, -1.0, -1.0])
    track = track_of(muscle, contraction=contraction, direction=direction)
    force = friction.along(np.zeros(4), track, friction.rest())
    # Dahl: the sign nears the direction by a factor e in each distance.
    signs = [1.0, 2 / np.e - 1, 2 / np.e**2 - 1, 2 * np.exp(-10) - 1]
    assert force == pytest.approx([-15 * sign for sign in signs])
