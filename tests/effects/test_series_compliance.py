"""A tendon that stretches under the pull."""

import numpy as np
import pytest

from gripperd.diagnose.fit.candidates import forms
from gripperd.effects.series_compliance import Measured, SeriesCompliance
from gripperd.model import Muscle
from tests.effects.tracks import track_of


def test_the_opening_is_wider_in_proportion_to_the_pull(muscle: Muscle) -> None:
    # 0.001 mm a newton.
    effect = SeriesCompliance(compliance=1e-6)
    track = track_of(muscle, force=np.array([0.0, 250.0, 500.0]))
    found = effect.along(np.full(3, 0.040), track, effect.rest())
    assert found == pytest.approx([0.04000, 0.04025, 0.04050])


@pytest.mark.parametrize("force", [-20.0, np.nan])
def test_a_slack_muscle_stretches_nothing(muscle: Muscle, force: float) -> None:
    effect = SeriesCompliance(compliance=1e-6)
    track = track_of(muscle, force=force)
    assert effect.along(np.array([0.040]), track, effect.rest()) == 0.040


def test_only_the_pull_stretches_it() -> None:
    effect = SeriesCompliance(compliance=1e-6)
    assert effect.widening(50.0, 400.0) == pytest.approx(0.4e-3)
    assert effect.widening(50.0, 0.0) == 0.0


def test_a_muscle_inside_the_stretch_is_shorter_than_measured() -> None:
    stretch = SeriesCompliance(shortening=5e-6)
    assert stretch.hidden_contraction(800.0) == pytest.approx(0.004)
    assert SeriesCompliance(compliance=1e-5).hidden_contraction(800.0) == 0.0


def test_a_rope_that_is_pulled_taut_gives_less() -> None:
    """As stiff again with 250 N, to the jaws and to the muscle alike."""
    rope = SeriesCompliance(compliance=1e-6, shortening=5e-6, stiffening=0.004)
    felt = 250.0 * np.log(2)
    assert rope.widening(0.0, 250.0) == pytest.approx(1e-6 * felt)
    assert rope.hidden_contraction(250.0) == pytest.approx(5e-6 * felt)
    assert rope.stiffens
    assert not SeriesCompliance(compliance=1e-6).stiffens


def test_a_length_that_is_told_of_the_muscle_alone_is_its_own() -> None:
    told = SeriesCompliance(shortening=5e-6, measured=Measured.INSIDE)
    assert told.hidden_contraction(800.0) == 0.0


def test_no_small_step_leads_from_one_length_to_the_other() -> None:
    """So both are searched, and the one inside hides nothing."""
    found = {form.measured: form.shortening > 0 for form in _forms()}
    assert found == {Measured.OUTSIDE: True, Measured.INSIDE: False}


def _forms() -> list[SeriesCompliance]:
    return [
        form for form in forms(SeriesCompliance) if isinstance(form, SeriesCompliance)
    ]
