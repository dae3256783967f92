import numpy as np
import pytest

from gripperd.model.memory import begin, dahl, lag, leaked, play, trail

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


def test_what_trails_a_ramp_is_as_much_behind_however_often_it_is_read() -> None:
    """Of ``y + T y' = 3 t`` from rest: ``y = 3 (t - T (1 - exp(-t / T)))``."""
    for time in (TIME, TIME[::7], TIME**1.5):
        step = np.diff(time, prepend=0.0)
        found = trail(3 * time, step, 0.4, begin(2))
        assert found == pytest.approx(3 * (time + 0.4 * np.expm1(-time / 0.4)))


def test_what_trails_may_be_read_piece_by_piece() -> None:
    sent = np.where(KNOWN, np.sin(TIME), np.nan)
    state = begin(2)
    pieces = [
        trail(sent[piece], STEP[piece], 0.7, state)
        for piece in (slice(0, 17), slice(17, 22), slice(22, None))
    ]
    assert np.concatenate(pieces) == pytest.approx(trail(sent, STEP, 0.7, begin(2)))


def test_what_trails_settles_at_the_first_sample_that_is_known() -> None:
    found = trail(np.array([np.nan, 3.0, 3.0]), np.full(3, 0.1), 2.0, begin(2))
    assert np.isnan(found[0])
    assert found[1:] == pytest.approx([3.0, 3.0])


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
