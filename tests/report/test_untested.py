from dataclasses import replace

import pytest

from gripperd.demo.hidden import Hidden
from gripperd.diagnose.diagnosis import Diagnosis
from gripperd.diagnose.fit.candidates import KEPT
from gripperd.report import page
from gripperd.report.untested import untested
from tests.demonstration import example

MODEL_LINE = "nonlinear_elasticity: rubber_elasticity is not in the model"


@pytest.fixture(scope="module")
def creep() -> Diagnosis:
    """Of a model without any effect; temperature was not measured."""
    return example(Hidden.CREEP)[1]


def test_what_was_not_tested_stands_before_the_reason(creep: Diagnosis) -> None:
    told = untested(creep)
    assert MODEL_LINE in told.model
    (line,) = [one for one in told.recording if "temperature not measured" in one]
    assert line.startswith("temperature_stiffness")


def test_no_other_recording_would_help_a_model_that_lacks_the_effect(
    creep: Diagnosis,
) -> None:
    told = untested(creep)
    assert len(told.recording) > 1
    assert not any("in the model" in line for line in told.recording)
    assert all(line.endswith("is not in the model") for line in told.model)


def test_what_the_model_has_is_kept_in_its_form(creep: Diagnosis) -> None:
    told = untested(replace(creep, untested={"creep": KEPT, "leak": "too short"}))
    assert told.model == (f"creep: {KEPT}",)
    assert told.recording == ("leak: too short",)


def test_the_page_keeps_the_model_apart_from_the_recording(creep: Diagnosis) -> None:
    text = page(creep, model="as-drawn", program="0.1.0")
    before, after = text.split("Not tested with this model")
    assert f"<li>{MODEL_LINE}</li>" in after
    assert "not measured</li>" in before
    assert "What this recording cannot show" in before


def test_a_page_without_either_has_no_empty_heading(creep: Diagnosis) -> None:
    text = page(replace(creep, untested={}), model="as-drawn", program="0.1.0")
    assert "Not tested with this model" not in text
    assert "What this recording cannot show" not in text
