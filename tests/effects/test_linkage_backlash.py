"""Lost motion between muscle and jaws."""

import numpy as np
import pytest

from gripperd.effects.linkage_backlash import LinkageBacklash
from gripperd.model import Direction, Muscle
from tests.effects.tracks import track_of

WIDTH = 0.4e-3


def test_the_jaws_stand_still_until_the_play_is_taken_up(muscle: Muscle) -> None:
    effect = LinkageBacklash(width=WIDTH)
    told = 1e-3 * np.array([80.0, 70.0, 70.3, 70.4, 70.5, 75.0])
    found = effect.along(told, track_of(muscle, contraction=told), effect.rest())
    expected = 1e-3 * np.array([80.0, 70.2, 70.2, 70.2, 70.3, 74.8])
    assert found == pytest.approx(expected)


def test_a_grip_holds_the_jaws_to_the_side_to_which_they_close(muscle: Muscle) -> None:
    """Pressed on a soft object and eased, they lose nothing until they let go."""
    told = 1e-3 * np.array([80.0, 50.0, 48.0, 50.0, 52.0, 53.0, 60.0])
    grip = np.array([0.0, 20.0, 40.0, 20.0, 0.0, 0.0, 0.0])
    track = track_of(muscle, contraction=told, grip=grip)
    held, free = (
        LinkageBacklash(width=2e-3, closed=share).along(told, track, np.full(1, np.nan))
        for share in (1.0, 0.0)
    )
    assert 1e3 * held == pytest.approx([80.0, 51.0, 49.0, 51.0, 51.0, 52.0, 59.0])
    assert 1e3 * free == pytest.approx([80.0, 51.0, 49.0, 49.0, 51.0, 52.0, 59.0])


def test_without_a_grip_cell_nothing_holds_them(muscle: Muscle) -> None:
    told = 1e-3 * np.array([80.0, 50.0, 48.0, 50.0])
    track = track_of(muscle, contraction=told, grip=np.nan)
    effect = LinkageBacklash(width=2e-3, closed=1.0)
    found = 1e3 * effect.along(told, track, effect.rest())
    assert found == pytest.approx([80.0, 51.0, 49.0, 49.0])


def test_a_record_may_begin_on_the_side_where_the_way_there_left_it(
    muscle: Muscle,
) -> None:
    # Opening to rest length leaves the jaws closer, closing leaves them further apart.
    effect = LinkageBacklash(width=WIDTH, begun=1.0, parked=1.0)
    for contraction, side in ((0.0, -1), (0.005, 0), (0.01, 1), (0.2, 1)):
        track = track_of(muscle, contraction=np.full(3, contraction))
        found = effect.along(np.full(3, 0.05), track, effect.rest())
        assert found == pytest.approx(np.full(3, 0.05 + side * WIDTH / 2))


def test_jaws_at_rest_length_may_lie_on_the_side_to_which_they_never_went(
    muscle: Muscle,
) -> None:
    """Pushed open by hand: as far apart as closing leaves them."""
    effect = LinkageBacklash(width=WIDTH, begun=1.0, parked=-1.0)
    for contraction in (-0.001, 0.0, 0.005, 0.01, 0.2):
        track = track_of(muscle, contraction=np.full(3, contraction))
        found = effect.along(np.full(3, 0.05), track, effect.rest())
        assert found == pytest.approx(np.full(3, 0.05 + WIDTH / 2))


def test_only_a_record_without_a_past_begins(muscle: Muscle) -> None:
    effect = LinkageBacklash(width=WIDTH, begun=1.0)
    memory = np.array([0.05])
    track = track_of(muscle, contraction=np.full(3, 0.2))
    assert (effect.along(np.full(3, 0.05), track, memory) == 0.05).all()


def test_nothing_of_it_stays_once_settled() -> None:
    effect = LinkageBacklash(width=WIDTH)
    assert effect.widening(50.0, 400.0) == 0.0
    assert effect.transmitted(50.0, Direction.CONTRACTING) == 50.0
