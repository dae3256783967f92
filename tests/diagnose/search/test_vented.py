"""A regulator that vents when it is asked for nothing, written from its description."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from gripperd.diagnose.diagnosis import diagnose
from gripperd.diagnose.readings.recording import Recording
from gripperd.diagnose.search.vented import with_vented_zero
from gripperd.diagnose.setup import problem_of
from gripperd.diagnose.verdict.conclude import Verdict
from gripperd.effects import EFFECTS
from tests.diagnose.small import (
    MODEL,
    altered,
    moments,
    nothing,
    recording,
    textbook,
    without,
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


@pytest.mark.parametrize(("kilopascals", "vents"), [(4.0, True), (4.0, False)])
def test_whether_a_regulator_vents_is_told(*, kilopascals: float, vents: bool) -> None:
    problem = problem_of(_off(kilopascals, vents=vents), MODEL, TOLERANCES)
    told = with_vented_zero(problem, []).model.vents
    assert told == (0.0 if vents else None)


def test_a_line_that_is_off_within_its_tolerance_is_no_effect() -> None:
    found = diagnose(_off(4.0, vents=True), MODEL, TOLERANCES, VALVES)
    assert found.verdict is Verdict.NONE


def test_one_that_is_off_by_far_is_named_all_the_same() -> None:
    found = diagnose(_off(18.0, vents=True), MODEL, TOLERANCES, VALVES)
    assert [entry.name for entry in found.named] == ["valve_offset"]


def test_without_a_command_there_is_nothing_to_decide() -> None:
    problem = problem_of(without(_off(4.0, vents=True), "current"), MODEL, TOLERANCES)
    assert with_vented_zero(problem, []) is problem


def test_one_that_is_always_asked_for_something_is_not_seen_to_vent() -> None:
    told = _off(4.0, vents=True)
    for name in moments():
        told = altered(told, [name], "current", partial(np.maximum, 4.4e-3))
    problem = problem_of(told, MODEL, TOLERANCES)
    assert with_vented_zero(problem, []) is problem
