import numpy as np
import pytest

from gripperd.model.memory import begin, dahl, lag, leaked, play

TIME = np.arange(0.0, 6.0, 0.1)
STEP = np.diff(TIME, prepend=0.0)
GAP = slice(20, 23)
KNOWN = np.ones(TIME.size, dtype=np.bool_)
KNOWN[GAP] = False


def test_a_lag_goes_on_to_where_it_was_sent_last() -> None:
    sent = np.where(TIME > 0, 5.0, 0.0)
    found = lag(np.where(KNOWN, sent, np.nan), STEP, 2.0, begin())
    assert found == pytest.approx(5 * -np.expm1(-TIME / 2))


def test_a_lag_settles_at_the_first_sample_that_is_known() -> None:
    sent = np.array([np.nan, np.nan, 3.0, 4.0])
    found = lag(sent, np.full(4, 0.1), 2.0, begin())
    assert np.isnan(found[:2]).all()
    assert found[2:] == pytest.approx([3.0, 4.0 - np.exp(-0.05)])


def test_dry_friction_is_still_turning_after_a_sample_that_is_missing() -> None:
    """Dahl: after a reversal the sign nears the other by ``1 - 1/e`` a distance."""
    way = np.where(KNOWN, 10.0 - TIME, np.nan)
    direction = np.where(TIME > 0, -1.0, 1.0)
    found = dahl(way, direction, np.ones(TIME.size), 4.0, begin(2))
    assert found[KNOWN] == pytest.approx((2 * np.exp(-TIME / 4) - 1)[KNOWN])


def test_dry_friction_keeps_its_sign_where_the_direction_is_missing() -> None:
    direction = np.where(KNOWN, np.where(TIME > 0, -1.0, 1.0), np.nan)
    found = dahl(10.0 - TIME, direction, np.ones(TIME.size), 4.0, begin(2))
    assert found[KNOWN] == pytest.approx((2 * np.exp(-TIME / 4) - 1)[KNOWN])


def test_play_keeps_its_place_where_the_signal_is_missing() -> None:
    found = play(np.array([0.0, 3.0, np.nan, 2.5, 0.0]), 1.0, begin())
    assert found == pytest.approx([0.0, 2.0, 2.0, 2.0, 1.0])


def test_air_leaks_on_while_nobody_reads_the_pressure() -> None:
    trapped = np.where(KNOWN, 3.0, np.nan)
    lost = leaked(trapped, STEP, TIME, (0.1, 0.0, 1.0), np.zeros(2))
    assert lost[KNOWN] == pytest.approx(3 * -np.expm1(-0.1 * TIME[KNOWN]))
