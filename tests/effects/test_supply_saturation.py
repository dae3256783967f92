"""A supply that clips the range, or sags."""

from math import log

import numpy as np
import pytest

from gripperd.effects.supply_saturation import SupplySaturation
from gripperd.model import Muscle
from tests.effects.tracks import track_of

SPAN = (0.0, 500e3)
ASKED = np.array([0.0, 200e3, 400e3, 450e3, 500e3])


def test_a_full_share_clips_at_the_limit(muscle: Muscle) -> None:
    effect = SupplySaturation(share=1.0, limit=0.8)
    found = effect.along(ASKED, track_of(muscle, command=ASKED), effect.rest())
    assert found == pytest.approx(np.minimum(ASKED, 400e3))
    assert effect.settled(ASKED, SPAN) == pytest.approx(np.minimum(ASKED, 400e3))


def test_half_a_share_lets_half_of_the_rest_through() -> None:
    effect = SupplySaturation(share=0.5, limit=0.8)
    assert effect.settled(500e3, SPAN) == pytest.approx(450e3)


def test_a_soft_corner_is_rounded_and_far_from_it_the_same() -> None:
    effect = SupplySaturation(share=1.0, limit=0.8, softness=0.03)
    assert effect.settled(400e3, SPAN) == pytest.approx(400e3 - 15e3 * log(2))
    assert effect.settled(100e3, SPAN) == pytest.approx(100e3, abs=0.01)
    assert effect.settled(900e3, SPAN) == pytest.approx(400e3, abs=0.01)


@pytest.mark.parametrize(("limit", "softness"), [(0.05, 0.2), (0.7, 0.2), (0.9, 0.03)])
def test_nothing_comes_where_nothing_is_asked(limit: float, softness: float) -> None:
    effect = SupplySaturation(share=1.0, limit=limit, softness=softness)
    settled = np.asarray(effect.settled(np.linspace(0.0, 500e3, 50), SPAN))
    assert settled[0] == pytest.approx(0.0, abs=1e-9)
    assert np.all(np.diff(settled) > 0)


def test_a_reading_that_is_missing_stays_so_in_silence() -> None:
    effect = SupplySaturation(share=1.0, limit=0.8, softness=0.03)
    asked = np.array([np.nan, 0.0])
    assert np.isnan(effect.settled(asked, SPAN)).tolist() == [True, False]


def test_the_ceiling_sinks_with_a_supply_that_is_measured(muscle: Muscle) -> None:
    effect = SupplySaturation(share=1.0, limit=0.9)
    track = track_of(muscle, supply_drop=np.array([0.0, 0.0, 10e3, 100e3]))
    found = effect.along(np.full(4, 480e3), track, effect.rest())
    assert found == pytest.approx([450e3, 450e3, 440e3, 350e3])


def test_a_sag_costs_most_at_the_top_of_the_line(muscle: Muscle) -> None:
    effect = SupplySaturation(share=0.0, sag=0.1)
    track = track_of(muscle, supply_drop=np.array([0.0, 100e3, 100e3]))
    found = effect.along(np.array([500e3, 500e3, 250e3]), track, effect.rest())
    assert found == pytest.approx([500e3, 490e3, 245e3])


@pytest.mark.parametrize(
    ("effect", "name"),
    [
        pytest.param(
            SupplySaturation(share=0.04, limit=0.1), "valve_gain", id="factor"
        ),
        pytest.param(
            SupplySaturation(share=0.04, limit=0.5), "", id="of half the line"
        ),
        pytest.param(SupplySaturation(share=1.0, limit=0.1), "", id="it clips"),
        pytest.param(
            SupplySaturation(share=0.04, limit=0.1, sag=0.1), "", id="it sags as well"
        ),
    ],
)
def test_a_factor_of_nearly_the_whole_line_is_no_ceiling(
    effect: SupplySaturation, name: str
) -> None:
    assert effect.becomes == name
