from dataclasses import replace

import pytest

from gripperd.cli.verdict import show
from gripperd.demo.hidden import Hidden
from gripperd.diagnose.diagnosis import Diagnosis
from gripperd.diagnose.readings.recording import Contradiction, Rejection
from gripperd.diagnose.verdict.conclude import Verdict
from gripperd.diagnose.verdict.extrapolation import Extrapolation
from gripperd.diagnose.verdict.named import Estimate
from tests.demonstration import example


@pytest.fixture(scope="module")
def creep() -> Diagnosis:
    return example(Hidden.CREEP)[1]


def told(diagnosis: Diagnosis, capsys: pytest.CaptureFixture[str]) -> str:
    show(diagnosis)
    return capsys.readouterr().out


def test_a_number_says_when_a_bound_holds_it(
    creep: Diagnosis, capsys: pytest.CaptureFixture[str]
) -> None:
    (found,) = creep.named
    estimates = {
        "slow": Estimate(0.15, 0.0312, -0.15, 0.15),
        "time": Estimate(0.5359, 0.094),
        "fresh": Estimate(0.0, 0.0),
    }
    entry = replace(found, parameters=estimates, p_value=0.0)
    text = told(replace(creep, named=(entry,)), capsys)
    assert "slow 0.150 ± 0.031, at its bound" in text
    assert "time_s 0.536 ± 0.094 " in text
    assert "fresh 0, chosen" in text
    assert "of pull" in text
    assert " < 1e-99 " in text


@pytest.mark.parametrize("verdict", [Verdict.NONE, Verdict.UNEXPLAINED])
def test_what_is_not_established_has_no_gap_of_its_own(
    creep: Diagnosis, capsys: pytest.CaptureFixture[str], verdict: Verdict
) -> None:
    text = told(replace(creep, verdict=verdict), capsys)
    assert "recalibrated  noise floor" in text
    assert "with what was found" not in text


def test_what_was_left_out_is_a_line_for_each_reason(
    creep: Diagnosis, capsys: pytest.CaptureFixture[str]
) -> None:
    rejected = tuple(Rejection(f"run_{n}", "force_N", n, "frozen") for n in (1, 2, 3))
    clash = Contradiction(("a",), ("b", "c"), "force_N", -129.0, "N", 4.9)
    recording = replace(creep.recording, rejected=rejected, contradictions=(clash,))
    text = told(replace(creep, recording=recording), capsys)
    assert "  6 of force_N in run_1, run_2 and run_3, frozen\n" in text
    assert (
        "force_N of a differs from that of b and c by 129 N at the same place, and"
        " repeats by 4.9 N"
    ) in text


def test_names_of_runs_are_told_as_they_are(
    creep: Diagnosis, capsys: pytest.CaptureFixture[str]
) -> None:
    where = tuple(
        replace(one, run=name)
        for one, name in zip(creep.where, ("a[/x]", "b [red]", "c :100:"), strict=False)
    )
    text = told(replace(creep, where=where), capsys)
    assert all(f" {one.run} " in text for one in where)


def test_what_the_model_lacks_is_told_apart_from_what_was_not_recorded(
    creep: Diagnosis, capsys: pytest.CaptureFixture[str]
) -> None:
    of_recording, of_model = (
        told(creep, capsys)
        .partition("not testable with this recording\n")[2]
        .split("not testable with this model\n")
    )
    assert "temperature_stiffness: temperature not measured\n" in of_recording
    assert "nonlinear_elasticity: rubber_elasticity is not in the model" in of_model


def test_what_lies_beyond_all_others_is_told_once(
    creep: Diagnosis, capsys: pytest.CaptureFixture[str]
) -> None:
    """With one run its end is all that is held out, and goes where nothing else did."""
    beyond = Extrapolation(("a (last quarter)",), creep.gaps)
    text = told(replace(creep, extrapolation=beyond), capsys)
    assert text.count("noise floor") == 1
    assert "a (last quarter): nothing else was held out" in text
