"""A regulator that vents when it is asked for nothing, written from its description."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from gripperd.diagnose.diagnosis import diagnose
from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.readings.recording import Recording
from gripperd.diagnose.search.vented import with_vented_zero
from gripperd.diagnose.setup import problem_of
from gripperd.diagnose.verdict.conclude import Verdict
from gripperd.effects import EFFECTS
from gripperd.effects.valve_gain import ValveGain
from gripperd.effects.valve_offset import ValveOffset, Zero
from tests.diagnose.fitted import ended, fitted
from tests.diagnose.small import (
    MODEL,
    altered,
    moments,
    nothing,
    recording,
    textbook,
)

TOLERANCES = {"valve.pressure_low": 2.5e3, "valve.pressure_high": 2.5e3}
VALVES = {
    name: EFFECTS[name]
    for name in ("valve_offset", "valve_gain", "pressure_sensor_bias")
}


def _off(kilopascals: float, *, vents: bool) -> Recording:
    """Its line is off by so much; asked for less than 1 kPa it may vent."""
    told = recording(nothing)
    for name, moment in moments().items():
        asked = moment.pressure
        gives = asked + 1e3 * kilopascals * ((asked > 1e3) | (not vents))
        more = textbook(replace(moment, pressure=gives)) - textbook(moment)
        told = altered(told, [name], "pressure", partial(np.add, gives - asked))
        told = altered(told, [name], "force", partial(np.add, more))
    return told


@pytest.mark.parametrize(
    ("kilopascals", "vents", "zero", "is_read_so"),
    [
        pytest.param(4.0, True, Zero.SUPPRESSED, True, id="within its tolerance"),
        pytest.param(18.0, True, Zero.SUPPRESSED, False, id="off by far"),
        pytest.param(4.0, False, Zero.REGULATED, False, id="keeps its line"),
    ],
)
def test_an_offset_within_tolerance_is_a_line_of_a_regulator_that_vents(
    kilopascals: float, zero: Zero, *, vents: bool, is_read_so: bool
) -> None:
    problem = problem_of(_off(kilopascals, vents=vents), MODEL, TOLERANCES)
    offset = ValveOffset(offset=1e3 * kilopascals, zero=zero)
    rival = fitted(problem, Candidate("valve_offset", offset))
    told = with_vented_zero(ended(problem, rival))
    assert told.model.vents == (0.0 if is_read_so else None)
    assert (told is problem) is not is_read_so


def test_a_line_that_is_off_within_its_tolerance_is_no_effect() -> None:
    found = diagnose(_off(4.0, vents=True), MODEL, TOLERANCES, VALVES)
    assert found.verdict is Verdict.NONE


def test_one_that_is_off_by_far_is_named_all_the_same() -> None:
    found = diagnose(_off(18.0, vents=True), MODEL, TOLERANCES, VALVES)
    assert [entry.name for entry in found.named] == ["valve_offset"]


def test_where_no_offset_was_found_nothing_is_decided() -> None:
    problem = problem_of(_off(4.0, vents=True), MODEL, TOLERANCES)
    gain = fitted(problem, Candidate("valve_gain", ValveGain(error=0.01)))
    assert with_vented_zero(ended(problem, gain)) is problem
