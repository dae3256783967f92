import json
import math
from dataclasses import replace
from typing import Any

import pytest

from gripperd.demo.hidden import Hidden
from gripperd.demo.rig import THRESHOLD
from gripperd.diagnose.diagnosis import Diagnosis
from gripperd.diagnose.document import document
from gripperd.diagnose.readings.recording import Contradiction, Kind, Rejection
from gripperd.diagnose.verdict.conclude import Verdict
from gripperd.diagnose.verdict.extrapolation import Extrapolation
from gripperd.diagnose.verdict.named import Estimate
from gripperd.diagnose.verdict.next_experiment import Proposal
from gripperd.model.effect import Signal
from tests.demonstration import example
from tests.diagnose.offered import bump


@pytest.fixture(scope="module")
def creep() -> Diagnosis:
    return example(Hidden.CREEP)[1]


@pytest.fixture(scope="module")
def threshold() -> Diagnosis:
    return example(Hidden.THRESHOLD)[1]


def written(diagnosis: Diagnosis) -> dict[str, Any]:
    """The document as a program reads it: strict JSON there and back."""
    said = document(diagnosis, model="as-drawn", program="0.1.0")
    read = json.loads(json.dumps(said, allow_nan=False))
    assert isinstance(read, dict)
    return read


def test_it_has_every_key_of_the_contract(creep: Diagnosis) -> None:
    said = written(creep)
    assert said.keys() >= {
        "verdict", "effects", "where", "gap", "gaps", "next_experiment",
        "rejected_samples", "unexplained",
    }  # fmt: skip
    (effect,) = said["effects"]
    assert effect.keys() >= {
        "name", "stage", "statement", "parameters", "equivalents", "evidence",
    }  # fmt: skip
    assert effect["chosen"] == {"of": "pull", "holds": "settled"}
    assert effect["evidence"].keys() == {"p_value", "delta_bic", "heldout_gain"}
    assert said["where"][0].keys() >= {
        "stage", "signal", "run", "region", "bias", "unit", "p_value",
    }  # fmt: skip
    assert said["gap"].keys() == {
        "signal", "unit", "rmse_before", "rmse_recalibrated", "rmse_after",
        "noise_floor", "ci95_after", "heldout_runs", "extrapolation",
    }  # fmt: skip
    assert said["gap"]["extrapolation"] is None
    assert said["unexplained"] == {
        "signature": [], "correction": "none", "corrections": [],
    }  # fmt: skip


@pytest.mark.parametrize(
    ("verdict", "is_told"),
    [
        (Verdict.NAMED, True),
        (Verdict.AMBIGUOUS, True),
        (Verdict.UNEXPLAINED, False),
        (Verdict.NONE, False),
    ],
)
def test_constants_are_those_of_the_model_that_is_told(
    creep: Diagnosis, verdict: Verdict, is_told: bool
) -> None:
    """A name that is withdrawn takes its constants with it."""
    told = creep.contest.best if is_told else creep.found.null
    index = [one.path for one in creep.found.problem.constants].index("muscle.diameter")
    shift = float(told.fit.point.shifts[index])
    known = creep.found.problem.constants[index]
    (said,) = [
        one["fit"]
        for one in written(replace(creep, verdict=verdict))["constants"]
        if one["name"] == "muscle.diameter_mm"
    ]
    assert said == pytest.approx(1e3 * (known.nominal + shift * known.sigma), rel=1e-4)


def test_what_lies_beyond_the_search_has_a_gap_of_its_own(creep: Diagnosis) -> None:
    gap = replace(creep.gaps[Signal.FORCE], before=40.0, recalibrated=30.0, after=20.0)
    beyond = Extrapolation(("fast",), {Signal.FORCE: gap})
    said = written(replace(creep, extrapolation=beyond))
    apart = said["gaps"]["force_N"]["extrapolation"]
    assert apart["heldout_runs"] == ["fast"]
    sizes = (apart[f"rmse_{one}"] for one in ("before", "recalibrated", "after"))
    assert tuple(sizes) == (40.0, 30.0, 20.0)
    assert said["gaps"]["force_N"]["rmse_after"] != 20.0
    assert said["gaps"]["pressure_kPa"]["extrapolation"] is None


def test_a_correction_is_described_in_the_units_of_its_keys(creep: Diagnosis) -> None:
    unexplained = replace(creep, verdict=Verdict.UNEXPLAINED, corrections=(bump(),))
    told = written(unexplained)["unexplained"]
    assert told["correction"] == "gp"
    (one,) = told["corrections"]
    assert (one["signal"], one["unit"], one["amplitude"]) == ("force_N", "N", 40.0)
    assert one["lengthscales"] == {"pressure_kPa": 50.0, "contraction": None}
    # What varied reaches 2 % of its range further; what did not, no further at all.
    assert one["fence"]["ranges"] == {
        "pressure_kPa": [-8.0, 408.0],
        "contraction": [-0.004, 0.204],
        "temperature_C": [21.0, 22.0],
    }
    assert one["adds_to"].endswith("constants as they were fitted")
    assert one["heldout"]["rmse_without"] == 20.0
    assert one["heldout"]["rmse_with"] == 5.0


def test_a_correction_s_table_follows_it_and_ends_at_the_fence(
    creep: Diagnosis,
) -> None:
    told = written(replace(creep, corrections=(bump(),)))["unexplained"]
    (table,) = told["corrections"][0]["tables"]
    assert table["held"] == {}
    values = dict(zip(table["pressure_kPa"], table["values"], strict=True))
    assert values[200.0] == pytest.approx(30.0, abs=0.1)
    assert values[0.0] is None
    stds = dict(zip(table["pressure_kPa"], table["std"], strict=True))
    assert stds[200.0] == pytest.approx(0.1, abs=0.01)
    assert stds[0.0] is None
    # Two places to a length of 50 kPa.
    assert table["pressure_kPa"][1] == 25.0


def test_what_is_hidden_is_named_with_the_keys_of_a_model_file(
    creep: Diagnosis,
) -> None:
    said = written(creep)
    assert said["verdict"] == "named"
    (effect,) = said["effects"]
    assert (effect["name"], effect["stage"]) == ("creep", "muscle")
    assert effect["parameters"].keys() == {
        "fast", "medium", "slow", "time_s", "leverage", "fresh", "stretch",
    }  # fmt: skip


def test_numbers_are_in_the_unit_of_their_key(threshold: Diagnosis) -> None:
    said = written(threshold)
    (effect,) = said["effects"]
    # The rig rounds the threshold off; far above it, it is what the pressure loses.
    value = effect["parameters"]["pressure_kPa"]["value"]
    assert value == pytest.approx(THRESHOLD / 1e3, rel=0.15)
    assert (said["gap"]["signal"], said["gap"]["unit"]) == ("force_N", "N")
    assert said["gaps"]["pressure_kPa"]["unit"] == "kPa"
    # The sensor's own noise is 1 kPa.
    assert said["gaps"]["pressure_kPa"]["noise_floor"] == pytest.approx(1, rel=0.25)


def test_a_place_lies_inside_the_recording(creep: Diagnosis) -> None:
    runs = {run.name for run in creep.recording.runs}
    last = max(float(run.columns["time"][-1]) for run in creep.recording.runs)
    for place in written(creep)["where"]:
        assert place["run"] in runs
        cut_by = place["region"].keys() - {"pressure_direction"}
        assert cut_by == {"t_s", "pressure_kPa", "contraction", "direction"}
        low, high = place["region"]["t_s"]
        assert 0 <= low <= high <= last
        low, high = place["region"]["pressure_kPa"]
        assert -10 < low <= high < 520


def test_a_wrong_constant_says_what_it_is_instead(creep: Diagnosis) -> None:
    wrong = replace(
        creep.named[0],
        name="parameter:muscle.diameter",
        stage="-",
        effect=None,
        path="muscle.diameter",
        parameters={"diameter": Estimate(18.6e-3, 0.1e-3)},
    )
    (effect,) = written(replace(creep, named=(wrong,)))["effects"]
    assert effect["name"] == "parameter:muscle.diameter_mm"
    assert effect["parameters"] == {"diameter_mm": {"value": 18.6, "std": 0.1}}
    assert effect["statement"] == (
        "The diameter is 18.60 ± 0.10 mm, not 20 mm; correct the model."
    )


def test_no_chance_is_written_as_zero(creep: Diagnosis) -> None:
    sure = replace(creep.named[0], p_value=0.0)
    where = (replace(creep.where[0], p_value=0.0),)
    said = written(replace(creep, named=(sure,), where=where))
    assert said["effects"][0]["evidence"]["p_value"] == 1e-99
    assert said["where"][0]["p_value"] == 1e-99


def test_rivals_are_told(creep: Diagnosis) -> None:
    entry = replace(
        creep.named[0], equivalents=("valve_lag", "parameter:valve.pressure_high")
    )
    said = written(replace(creep, verdict=Verdict.AMBIGUOUS, named=(entry,)))
    assert str(said["statement"]).startswith(
        "The model is off, and this recording cannot tell creep from valve lag or a"
        " wrong pressure at the high end of the valve;"
    )
    (effect,) = said["effects"]
    assert effect["equivalents"] == [
        "valve_lag", "parameter:valve.pressure_high_kPa",
    ]  # fmt: skip


@pytest.mark.parametrize(
    "verdict", [Verdict.UNEXPLAINED, Verdict.NONE, Verdict.UNUSABLE]
)
def test_a_verdict_without_a_name_lists_no_effect(
    creep: Diagnosis, verdict: Verdict
) -> None:
    said = written(replace(creep, verdict=verdict))
    assert said["effects"] == []
    assert [one["name"] for one in said["nearest"]] == ["creep"]


def test_a_number_that_is_not_finite_is_null(creep: Diagnosis) -> None:
    entry = replace(creep.named[0], p_value=math.nan, delta_bic=-math.inf)
    (effect,) = written(replace(creep, named=(entry,)))["effects"]
    assert effect["evidence"]["p_value"] is None
    assert effect["evidence"]["delta_bic"] is None


def test_everything_about_the_recording_is_passed_on(creep: Diagnosis) -> None:
    recording = replace(
        creep.recording,
        rejected=(Rejection("step_0", "current_mA", 3, "under 3.6 mA"),),
        contradictions=(Contradiction(("a",), ("b",), "force_N", 12.5, "N", 2.0),),
        remarks=("column lbf is not read",),
    )
    plan = Proposal(Kind.ISOBARIC, "separates A from B", "slow", {"t_s": [0, 9]})
    said = written(replace(creep, recording=recording, proposal=plan))
    assert said["rejected_samples"] == [
        {"run": "step_0", "column": "current_mA", "count": 3, "reason": "under 3.6 mA"}
    ]
    assert said["contradictions"][0]["difference"] == 12.5
    assert said["remarks"] == ["column lbf is not read"]
    assert said["next_experiment"] == {
        "kind": "isobaric", "why": "separates A from B", "plan": {"t_s": [0, 9]},
    }  # fmt: skip
    assert said["recording"]["sha256"] == creep.recording.digest
