"""A model that already has an effect, at a size that the rig has not."""

from dataclasses import replace

import pytest

from gripperd.diagnose.diagnosis import Diagnosis, diagnose
from gripperd.diagnose.verdict.conclude import Verdict
from gripperd.effects import EFFECTS
from gripperd.effects.coulomb_friction import CoulombFriction
from gripperd.effects.threshold_pressure import ThresholdPressure
from gripperd.effects.viscous_friction import ViscousFriction
from gripperd.model.effect import Effect
from tests.diagnose.conftest import FEW
from tests.diagnose.small import MODEL, Hidden, nothing, recording, threshold

WORD = "parameter:effects."
LIBRARY = {name: EFFECTS[name] for name in FEW}


def _judged(
    hidden: Hidden, known: Effect, tolerances: dict[str, float] | None = None
) -> Diagnosis:
    """What is found with a model that has an effect, among five that it may lack."""
    model = replace(MODEL, effects=(*MODEL.effects, known))
    return diagnose(recording(hidden), model, tolerances or {}, LIBRARY)


@pytest.mark.parametrize(
    ("known", "size"),
    [
        (CoulombFriction(magnitude=18.0), "coulomb_friction.magnitude_N"),
        (ThresholdPressure(pressure=25e3), "threshold_pressure.pressure_kPa"),
        (ViscousFriction(damping=2000.0), "viscous_friction.damping_N_s"),
    ],
)
def test_what_the_rig_has_not_got_is_found_to_be_nothing(
    known: Effect, size: str
) -> None:
    found = _judged(nothing, known)
    assert found.verdict is Verdict.NAMED
    (entry,) = found.named
    assert entry.name == f"{WORD}{size}"
    (told,) = entry.parameters.values()
    assert abs(told.value) < 2.5 * told.std


def test_what_the_rig_has_more_of_is_told_by_its_size() -> None:
    """Of another threshold than of the model, 40 kPa instead of 20."""
    found = _judged(threshold(40.0), ThresholdPressure(pressure=20e3))
    (entry,) = found.named
    assert entry.name == f"{WORD}threshold_pressure.pressure_kPa"
    (told,) = entry.parameters.values()
    assert told.value == pytest.approx(40e3, rel=0.1)


@pytest.mark.parametrize("hidden", [20.5, 19.5])
def test_what_is_off_within_its_tolerance_is_nothing_new(hidden: float) -> None:
    found = _judged(
        threshold(hidden),
        ThresholdPressure(pressure=20e3),
        {"effects.threshold_pressure.pressure": 500.0},
    )
    assert found.verdict is Verdict.NONE
