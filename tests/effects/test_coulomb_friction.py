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


@pytest.mark.parametrize(
    ("pressure", "share"),
    [(-2e3, 0.0), (0.0, 0.0), (5e3, 0.25), (2e4, 1.0), (4e5, 1.0)],
)
def test_loose_strands_rub_as_they_press(
    muscle: Muscle, pressure: float, share: float
) -> None:
    friction = CoulombFriction(15.0, seated=20e3)
    static = StaticMuscle(muscle, (friction,))
    contracting = static.force(pressure, 0.1, Direction.CONTRACTING)
    extending = static.force(pressure, 0.1, Direction.EXTENDING)
    assert extending - contracting == pytest.approx(30.0 * share)
    track = track_of(muscle, pressure=np.array([pressure]))
    force = friction.along(np.zeros(1), track, friction.rest())
    assert force.tolist() == pytest.approx([-15.0 * share])


@pytest.mark.parametrize("pressure", [5e3, 1.9e4, 2.1e4, 4e5])
def test_a_force_with_loose_strands_has_its_pressure(
    muscle: Muscle, pressure: float
) -> None:
    static = StaticMuscle(muscle, (CoulombFriction(15.0, seated=20e3),))
    for way in Direction:
        force = static.force(pressure, 0.05, way)
        assert static.pressure(force, 0.05, way) == pytest.approx(pressure)


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


def test_a_way_counts_in_full_whatever_holds_there(muscle: Muscle) -> None:
    friction = CoulombFriction(15.0, distance=1e-3)
    direction = np.array([1.0, 0.5])
    track = track_of(muscle, contraction=np.array([0.1, 0.101]), direction=direction)
    force = friction.along(np.zeros(2), track, friction.rest())
    assert force == pytest.approx([-15.0, -15.0 * (0.5 + 0.5 / np.e)])


def test_noise_at_rest_does_not_turn_it(muscle: Muscle) -> None:
    friction = CoulombFriction(15.0, distance=1e-3)
    noise = np.tile([1e-4, -1e-4], 200).astype(np.float64)
    direction = np.where(np.arange(400) < 2, 1.0, -1.0)
    track = track_of(muscle, contraction=0.1 + noise, direction=direction)
    force = friction.along(np.zeros(400), track, friction.rest())
    # One step back of 2e-4 is all that was gained.
    assert force[-1] == pytest.approx(-15 * (2 * np.exp(-0.2) - 1))


def test_what_creeps_rubs_less(muscle: Muscle) -> None:
    friction = CoulombFriction(15.0, distance=1e-3, slip=3e-3)
    rate = np.repeat(np.array([0.03, 0.0, 3e-3]), 100)
    contraction = np.interp(np.arange(300), [0, 99, 199, 299], [0.0, 0.3, 0.3, 0.33])
    track = track_of(muscle, contraction=contraction, rate=rate)
    force = friction.along(np.zeros(300), track, friction.rest())
    assert force[99:200] == pytest.approx(-15.0)
    assert force[299] == pytest.approx(-15.0 * np.tanh(1.0))
    back = track_of(muscle, contraction=-contraction, rate=-rate, direction=-1.0)
    opposite = friction.along(np.zeros(300), back, friction.rest())
    np.testing.assert_allclose(opposite, -force)


def test_without_a_distance_it_goes_by_the_rate_alone(muscle: Muscle) -> None:
    friction = CoulombFriction(15.0, slip=3e-3)
    rate = np.array([0.03, 3e-3, 0.0, -3e-3])
    track = track_of(muscle, rate=rate, direction=np.array([1.0, 1.0, 1.0, -1.0]))
    force = friction.along(np.zeros(4), track, friction.rest())
    assert force == pytest.approx(-15.0 * np.tanh(rate / 3e-3))


def test_a_muscle_is_held_by_what_its_travel_left(muscle: Muscle) -> None:
    friction = CoulombFriction(15.0, distance=1e-3, slip=3e-3)
    since = np.linspace(0.0, 5.0, 501)
    # It stops in 50 ms or so: from 0.1/s on, the last 1.5e-4 of the way are slow.
    rate = 0.1 * np.exp(-since / 0.05)
    way = 0.1 + 0.005 * (1 - np.exp(-since / 0.05))
    track = track_of(muscle, contraction=way, rate=rate)
    left = friction.along(np.zeros(501), track, friction.rest())[-1]
    ideal = StaticMuscle(muscle).force(2e5, 0.1)
    for direction in Direction:
        held = StaticMuscle(muscle, (friction,)).force(2e5, 0.1, direction)
        assert held - ideal == pytest.approx(direction * left, rel=0.15)


def test_without_a_distance_nothing_holds_it_at_rest(muscle: Muscle) -> None:
    static = StaticMuscle(muscle, (CoulombFriction(15.0, slip=3e-3),))
    ideal = StaticMuscle(muscle).force(2e5, 0.1)
    assert static.force(2e5, 0.1, Direction.CONTRACTING) == pytest.approx(ideal)


def test_it_rests_as_it_came(muscle: Muscle) -> None:
    friction = CoulombFriction(15.0, distance=1e-3, slip=3e-3)
    resting = track_of(muscle, contraction=np.full(5, 0.1), rate=0.0, direction=-1.2)
    force = friction.along(np.zeros(5), resting, friction.rest())
    assert force == pytest.approx(1.2 * 15.0)


@pytest.mark.parametrize("column", ["contraction", "rate", "direction"])
def test_what_is_not_known_is_not_known_for_one_sample(
    muscle: Muscle, column: str
) -> None:
    friction = CoulombFriction(15.0, distance=1e-3, slip=3e-3)
    columns = {
        "contraction": np.linspace(0.0, 0.1, 6),
        "rate": np.full(6, 0.1),
        "direction": np.ones(6),
    }
    columns[column][3] = np.nan
    track = track_of(muscle, **columns)
    force = friction.along(np.zeros(6), track, friction.rest())
    assert np.isnan(force).tolist() == [False] * 3 + [True] + [False] * 2
    assert force[-1] == pytest.approx(-15.0)
