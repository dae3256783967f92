"""Wrong zero of the contraction."""

import numpy as np
import pytest

from gripperd.effects.length_datum import LengthDatum
from gripperd.model import Muscle
from gripperd.model.effect import Signal
from tests.effects.tracks import track_of

TRUE = np.array([0.0, 0.1, 0.2])
READ = np.array([0.003, 0.103, 0.203])


def test_all_curves_are_shifted_along_the_contraction(muscle: Muscle) -> None:
    effect = LengthDatum(shift=0.003)
    track = track_of(muscle, contraction=TRUE)
    assert effect.along(TRUE, track, effect.rest()) == pytest.approx(READ)
    assert effect.truth(READ, track) == pytest.approx(TRUE)
    assert effect.signal is Signal.CONTRACTION
