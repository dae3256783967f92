"""Joints that rub in proportion to the load."""

import numpy as np
import pytest

from gripperd.effects.linkage_friction import LinkageFriction, Turning
from gripperd.model import Direction, Muscle
from tests.effects.tracks import eventful, samples, track_of


def test_grip_is_lost_closing_and_won_opening(muscle: Muscle) -> None:
    effect = LinkageFriction(loss=0.1)
    track = track_of(muscle, direction=np.array([1.0, 1.0, -1.0, -1.0]))
    found = effect.along(np.array([0.0, 50.0, 50.0, 20.0]), track, effect.rest())
    assert found == pytest.approx([0.0, 45.0, 55.0, 22.0])


def test_a_settled_grip_keeps_the_loss_of_the_last_travel() -> None:
    effect = LinkageFriction(loss=0.1)
    assert effect.transmitted(50.0, Direction.CONTRACTING) == pytest.approx(45.0)
    assert effect.widening(50.0, 400.0) == 0.0


def test_after_a_reversal_the_pull_winds_up_the_joints_before_they_turn(
    muscle: Muscle,
) -> None:
    effect = LinkageFriction(pull_loss=0.05, turn=50.0)
    way = np.array([200.0, 400.0, 600.0, 550.0, 500.0, 300.0])
    side = np.array([1.0, 1.0, 1.0, -1.0, -1.0, -1.0])
    for direction in (side, -side):
        track = track_of(muscle, force=way, direction=direction)
        found = effect.along(np.full(6, 100.0), track, effect.rest())
        # 1 - 2 exp(-n) of the way round, n turns after the reversal.
        turned = [1.0, 1.0, 1.0, 2 / np.e - 1, 2 / np.e**2 - 1, 2 / np.e**6 - 1]
        assert found == pytest.approx(100 - 0.05 * way * turned * direction[0])


def test_a_load_that_stays_turns_nothing(muscle: Muscle) -> None:
    effect = LinkageFriction(loss=0.1, turn=50.0)
    track = track_of(muscle, force=500.0, direction=np.array([1.0, -1.0, -1.0]))
    found = effect.along(np.full(3, 50.0), track, effect.rest())
    assert found == pytest.approx(45.0)


def test_joints_may_turn_with_the_way_of_the_muscle_whatever_it_pulls(
    muscle: Muscle,
) -> None:
    effect = LinkageFriction(loss=0.1, turn=50.0, distance=1e-3, by=Turning.TRAVEL)
    track = track_of(
        muscle,
        contraction=np.array([0.05, 0.06, 0.06, 0.06, 0.059, 0.058, 0.05]),
        force=np.array([200.0, 400.0, 900.0, 300.0, 200.0, 200.0, 200.0]),
        direction=np.array([1.0, 1.0, 1.0, 1.0, -1.0, -1.0, -1.0]),
    )
    found = effect.along(np.full(7, 100.0), track, effect.rest())
    # 1 - 2 exp(-n) of the way round, n distances after the reversal.
    turned = [1.0, 1.0, 1.0, 1.0, 2 / np.e - 1, 2 / np.e**2 - 1, 2 / np.e**10 - 1]
    assert found == pytest.approx(100 - 10 * np.array(turned))


@pytest.mark.parametrize(
    "effect",
    [
        LinkageFriction(pull_loss=0.05, turn=50.0),
        LinkageFriction(loss=0.3, distance=1e-3, by=Turning.TRAVEL),
    ],
)
def test_joints_that_turn_go_on_from_call_to_call(
    muscle: Muscle, effect: LinkageFriction
) -> None:
    track = eventful(muscle)
    whole = effect.along(np.full_like(track.time, 100.0), track, effect.rest())
    memory = effect.rest()
    piecewise = [
        effect.along(np.array([100.0]), sample, memory).item()
        for sample in samples(track)
    ]
    assert piecewise == pytest.approx(whole, abs=1e-9)
    assert np.ptp(whole) > 20
