import numpy as np
import pytest

from gripperd.diagnose.readings.leap import leaps
from gripperd.model.track import Array

REACH = 500e3
RAMP = np.linspace(0.0, REACH, 13)
SWEEP = np.concatenate([RAMP, RAMP[-2::-1]])
"""Up and down in a twelfth of the range a sample."""


def _leaps(value: Array, seconds: float) -> list[int]:
    step = np.full(value.size, seconds)
    step[0] = 0.0
    return np.flatnonzero(leaps(value, REACH, step)).tolist()


def test_a_ramp_in_few_slow_samples_does_not_leap() -> None:
    assert _leaps(SWEEP, 0.2) == []


def test_a_step_at_either_end_of_a_sweep_leaps() -> None:
    ends = np.r_[0.0, np.full(6, 0.5), 1.0] * REACH
    assert _leaps(ends, 0.2) == [1, 7]


def test_in_fast_samples_two_sensors_do_not_see_the_same() -> None:
    assert _leaps(SWEEP, 0.02) == list(range(1, SWEEP.size))


@pytest.mark.parametrize("seconds", [0.02, 0.2, 2.0])
def test_a_step_leaps_however_slow_the_samples(seconds: float) -> None:
    staircase = np.repeat([0.0, 0.5, 0.2, 1.0], 8) * REACH
    assert _leaps(staircase, seconds) == [8, 16, 24]


def test_a_small_change_is_no_leap() -> None:
    assert _leaps(np.repeat([0.0, 0.05 * REACH], 8), 0.02) == []


def test_what_settles_after_a_step_is_no_ramp() -> None:
    # A lag of 0.3 s, five samples a second: each change is half the one before.
    settling = REACH * (1 - np.exp(-np.maximum(np.arange(20) - 8, 0) / 1.5))
    assert _leaps(settling, 0.2) == [9, 10, 11, 12]
