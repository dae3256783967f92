"""Dry friction that grows with pressure."""

import numpy as np
import pytest

from gripperd.effects.pressure_friction import PressureFriction
from gripperd.model import Direction, Muscle, StaticMuscle
from gripperd.model.real import Real
from tests.effects.tracks import track_of


def width(muscle: Muscle, effect: PressureFriction, pressure: Real) -> Real:
    """Of the loop between both directions. [N]."""
    static = StaticMuscle(muscle, (effect,))
    extending = static.force(pressure, 0.1, Direction.EXTENDING)
    return extending - static.force(pressure, 0.1, Direction.CONTRACTING)


@pytest.mark.parametrize("exponent", [0.5, 1.0, 1.5])
def test_the_loop_widens_with_a_power_of_pressure(
    muscle: Muscle, exponent: float
) -> None:
    friction = PressureFriction(20.0, exponent)
    assert width(muscle, friction, 300e3) == pytest.approx(40.0)
    wider = width(muscle, friction, 600e3) / width(muscle, friction, 150e3)
    assert wider == pytest.approx(4**exponent)


def test_what_creeps_rubs_less_and_what_rests_not_at_all(muscle: Muscle) -> None:
    friction = PressureFriction(20.0, exponent=1.0, slip=3e-3)
    rate = np.array([0.03, 3e-3, 0.0, -3e-3])
    track = track_of(
        muscle, pressure=300e3, rate=rate, direction=np.array([1.0, 1.0, 1.0, -1.0])
    )
    force = friction.along(np.zeros(4), track, friction.rest())
    assert force == pytest.approx(-20.0 * np.tanh(rate / 3e-3))


def test_after_a_reversal_it_turns_round_within_its_distance(muscle: Muscle) -> None:
    friction = PressureFriction(20.0, exponent=1.0, distance=1e-3)
    contraction = np.array([0.1, 0.099, 0.098, 0.09])
    pressure = np.array([300e3, 300e3, 150e3, 600e3])
    direction = np.array([1.0, -1.0, -1.0, -1.0])
    track = track_of(
        muscle, pressure=pressure, contraction=contraction, direction=direction
    )
    force = friction.along(np.zeros(4), track, friction.rest())
    # Dahl: the sign nears the direction by a factor e in each distance.
    signs = np.array([1.0, 2 / np.e - 1, 2 / np.e**2 - 1, 2 * np.exp(-10) - 1])
    assert force == pytest.approx(-20.0 * np.array([1.0, 1.0, 0.5, 2.0]) * signs)


@pytest.mark.parametrize(("distance", "share"), [(0.0, 0.0), (1e-3, 1.0)])
def test_only_over_a_distance_is_a_muscle_held_by_what_its_travel_left(
    muscle: Muscle, distance: float, share: float
) -> None:
    friction = PressureFriction(20.0, exponent=1.0, distance=distance, slip=3e-3)
    assert width(muscle, friction, 300e3) == pytest.approx(40.0 * share)
    track = track_of(muscle, pressure=300e3, rate=np.zeros(2), direction=np.ones(2))
    force = friction.along(np.zeros(2), track, friction.rest())
    assert force == pytest.approx(-20.0 * share * np.ones(2))


@pytest.mark.parametrize("exponent", [0.5, 1.0])
def test_a_vented_or_evacuated_muscle_has_none(muscle: Muscle, exponent: float) -> None:
    loops = width(muscle, PressureFriction(20.0, exponent), np.array([0.0, -5e3]))
    assert loops == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("exponent", [0.5, 1.0])
@pytest.mark.parametrize("direction", Direction)
def test_its_pressure_is_found_again_from_the_pull(
    muscle: Muscle, exponent: float, direction: Direction
) -> None:
    static = StaticMuscle(muscle, (PressureFriction(20.0, exponent),))
    for pressure in (-40e3, 150e3, 500e3):
        force = static.force(pressure, 0.1, direction)
        assert static.pressure(force, 0.1, direction) == pytest.approx(
            pressure, abs=1e-3
        )
