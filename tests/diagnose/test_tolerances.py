"""Constants that lie beyond tolerances stated too tight."""

from dataclasses import replace

import pytest

from gripperd.diagnose.diagnosis import Diagnosis, diagnose
from gripperd.effects import EFFECTS
from tests.diagnose.small import MODEL, MUSCLE, REGULATOR, nothing, recording

LIBRARY = {
    name: EFFECTS[name]
    for name in ("threshold_pressure", "tapered_ends", "valve_gain", "valve_offset")
}
BORE = "parameter:muscle.diameter"
SPAN = "parameter:valve.pressure_high"


def _told(bore: float, span: float) -> Diagnosis:
    """A model whose bore and span are off by so much, and said to be within 0.3 %."""
    diameter = MUSCLE.diameter * (1 + bore)
    high = REGULATOR.pressure_high * (1 + span)
    model = replace(
        MODEL,
        muscle=replace(MUSCLE, diameter=diameter),
        regulator=replace(REGULATOR, pressure_high=high),
    )
    stated = {
        "muscle.rest_length": 0.003 * MUSCLE.rest_length,
        "muscle.diameter": 0.003 * diameter,
        "muscle.braid_angle": 1e-5,
        "valve.pressure_high": 0.003 * high,
    }
    return diagnose(recording(nothing), model, stated, LIBRARY)


@pytest.fixture(scope="module")
def both() -> Diagnosis:
    return _told(0.02, -0.02)


def test_several_constants_beyond_their_tolerance_are_no_effect(
    both: Diagnosis,
) -> None:
    assert {entry.name for entry in both.named} == {BORE, SPAN}


def test_they_are_told_as_they_were_built(both: Diagnosis) -> None:
    entries = {entry.name: entry for entry in both.named}
    bore = entries[BORE].parameters["diameter"].value
    span = entries[SPAN].parameters["pressure_high"].value
    assert bore == pytest.approx(MUSCLE.diameter, rel=0.003)
    assert span == pytest.approx(REGULATOR.pressure_high, rel=0.003)


def test_one_alone_is_what_shows_in_its_way() -> None:
    assert [entry.name for entry in _told(0.0, -0.02).named] == ["valve_gain"]
