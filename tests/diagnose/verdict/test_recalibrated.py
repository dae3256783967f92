"""A muscle whose bore is a little other than its drawing says."""

from dataclasses import replace

import pytest

from gripperd.diagnose.diagnosis import Diagnosis, diagnose
from gripperd.diagnose.document import document
from gripperd.diagnose.statement import summary
from gripperd.diagnose.verdict.conclude import Verdict
from gripperd.diagnose.verdict.recalibrated import recalibrated
from gripperd.model.effect import Signal
from tests.diagnose.small import MODEL, MUSCLE, recording

DRAWN, BUILT, TOLERANCE = 19.8, 20.0, 0.2
"""Bore. [mm]"""


@pytest.fixture(scope="module")
def narrow() -> Diagnosis:
    drawn = replace(MODEL, muscle=replace(MUSCLE, diameter=1e-3 * DRAWN))
    # All else is known well.
    known = {
        "muscle.rest_length": 1e-6, "muscle.braid_angle": 1e-6,
        "muscle.elastic_modulus": 1e2, "muscle.wall_thickness": 1e-8,
        "muscle.diameter": 1e-3 * TOLERANCE,
    }  # fmt: skip
    return diagnose(recording(), drawn, known, {})


def test_a_constant_is_told_in_the_unit_of_its_key(narrow: Diagnosis) -> None:
    told = recalibrated(narrow.found.problem, narrow.contest.best)
    (bore,) = (one for one in told if one.constant.path == "muscle.diameter")
    assert (bore.model, bore.tolerance) == pytest.approx((DRAWN, TOLERANCE))
    assert bore.fit == pytest.approx(BUILT, abs=4 * bore.std)
    assert bore.std < 0.05
    assert bore.moved == pytest.approx(1.0, abs=0.2)


def test_the_document_has_it_for_whoever_corrects_the_drawing(
    narrow: Diagnosis,
) -> None:
    said = document(narrow, model="as-drawn", program="0.1.0")["constants"]
    assert isinstance(said, list)
    (bore,) = (one for one in said if one["name"] == "muscle.diameter_mm")
    assert (bore["model"], bore["tolerance"]) == (DRAWN, TOLERANCE)
    assert bore["fit"] == pytest.approx(BUILT, abs=0.04)


def test_where_nothing_is_missing_it_is_said_what_had_to_move(
    narrow: Diagnosis,
) -> None:
    assert narrow.verdict is Verdict.NONE
    said = summary(narrow)
    assert "once constants move (diameter 19.97 mm instead of 19.8 mm first" in said


def test_what_hardly_moved_is_not_worth_a_word(narrow: Diagnosis) -> None:
    force = narrow.gaps[Signal.FORCE]
    gap = replace(force, recalibrated=0.9 * force.before)
    told = replace(narrow, gaps={**narrow.gaps, Signal.FORCE: gap})
    assert "Nothing is missing: what is left is noise" in summary(told)
