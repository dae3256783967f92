"""Lags in parallel."""

import numpy as np
import pytest

from gripperd.model.memory import begin
from gripperd.model.prony import followed

TIME = np.arange(0.0, 12.0, 0.1)
STEP = np.diff(TIME, prepend=0.0)
TIMES, SHARES = (0.5, 2.0, 8.0), (0.2, -0.3, 0.5)


def test_after_a_step_it_is_a_series_of_exponentials() -> None:
    sent = np.where(TIME > 0, 5.0, 0.0)
    come = -np.expm1(-TIME[:, None] / TIMES) @ SHARES
    found = followed(sent, STEP, TIMES, SHARES, begin(3))
    assert found == pytest.approx(5 * come)


@pytest.mark.parametrize("cut", [1, 30])
def test_the_memory_carries_from_one_piece_to_the_next(cut: int) -> None:
    sent = np.sin(TIME)
    memory = begin(3)
    pieces = [
        followed(sent[piece], STEP[piece], TIMES, SHARES, memory)
        for piece in (slice(cut), slice(cut, None))
    ]
    whole = followed(sent, STEP, TIMES, SHARES, begin(3))
    assert np.concatenate(pieces) == pytest.approx(whole)


def test_what_was_missing_is_what_was_known_before() -> None:
    known = np.where(TIME > 0, 5.0, 0.0)
    holed = known.copy()
    holed[20:23] = np.nan
    found, whole = (
        followed(sent, STEP, TIMES, SHARES, begin(3)) for sent in (holed, known)
    )
    np.testing.assert_array_equal(found, whole)


def test_a_lag_settles_at_the_first_sample_that_is_known() -> None:
    sent = np.array([np.nan, np.nan, 3.0, 4.0])
    found = followed(sent, np.full(4, 0.1), (2.0, 1.0, 1.0), (1.0, 0.0, 0.0), begin(3))
    assert np.isnan(found[:2]).all()
    assert found[2:] == pytest.approx([3.0, 4.0 - np.exp(-0.05)])


def test_a_lag_without_a_share_is_left_alone() -> None:
    memory = np.array([1.0, np.nan, 2.0])
    followed(np.ones(3), np.ones(3), TIMES, (0.0, 0.0, 1.0), memory)
    assert memory[0] == 1.0
    assert np.isnan(memory[1])
    assert memory[2] < 2.0
