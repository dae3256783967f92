"""A force sensor whose zero follows the clock."""

import numpy as np
import pytest

from gripperd.effects.force_sensor_drift import ForceSensorDrift
from gripperd.model import Muscle
from tests.effects.tracks import track_of

TRUE = np.array([100.0, 900.0, 100.0])


def test_the_error_grows_with_the_clock_whatever_the_muscle_does(
    muscle: Muscle,
) -> None:
    # 0.6 N a minute; the run began ten minutes into the recording.
    effect = ForceSensorDrift(rate=0.01)
    track = track_of(muscle, time=np.array([600.0, 660.0, 720.0]), force=TRUE)
    read = np.array([106.0, 906.6, 107.2])
    assert effect.along(TRUE, track, effect.rest()) == pytest.approx(read)
    assert effect.truth(read, track) == pytest.approx(TRUE)


def test_a_cell_that_warms_up_drifts_ever_less(muscle: Muscle) -> None:
    effect = ForceSensorDrift(rate=0.01, settling=1 / 600)
    track = track_of(muscle, time=np.array([0.0, 600.0, 1e6]), force=TRUE)
    # It ends where it would be after ten minutes at its first rate.
    read = TRUE + np.array([0.0, 6.0 * (1 - 1 / np.e), 6.0])
    assert effect.along(TRUE, track, effect.rest()) == pytest.approx(read)
    assert effect.truth(read, track) == pytest.approx(TRUE)
