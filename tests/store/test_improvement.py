from dataclasses import replace
from datetime import UTC, datetime
from math import sqrt
from pathlib import Path

import numpy as np
import pytest

from gripperd.config import ModelFile, load_model
from gripperd.demo.hidden import Hidden
from gripperd.demo.rig import Rig
from gripperd.diagnose.diagnosis import Diagnosis, diagnose
from gripperd.diagnose.verdict.conclude import Verdict
from gripperd.diagnose.verdict.named import Estimate
from gripperd.effects.braid_friction import BraidFriction
from gripperd.effects.coulomb_friction import CoulombFriction
from gripperd.effects.creep import Creep
from gripperd.effects.rubber_elasticity import RubberElasticity
from gripperd.effects.threshold_pressure import ThresholdPressure
from gripperd.errors import Refused
from gripperd.model import PressedObject, StaticMuscle
from gripperd.model.effect import Signal
from gripperd.store import Version, Versions
from gripperd.store.improvement import improvement
from tests.demonstration import SEED, example
from tests.diagnose.small import LINKAGE, MODEL, recording, with_jaws
from tests.diagnose.small import threshold as lacking

NOON = datetime(2026, 1, 31, 12, tzinfo=UTC)

Found = tuple[ModelFile, Diagnosis]


@pytest.fixture(scope="module")
def threshold() -> Found:
    return example(Hidden.THRESHOLD)


@pytest.fixture(scope="module")
def creep() -> Found:
    return example(Hidden.CREEP)


def kept(found: Found, folder: Path) -> Version:
    model, diagnosis = found
    better = improvement(model, diagnosis, "0.1.0")
    return Versions(folder, model).add(
        better.model, parent=0, created_at=NOON, provenance=better.provenance
    )


def test_the_version_pulls_like_the_rig_and_the_drawing_does_not(
    threshold: Found, tmp_path: Path
) -> None:
    rig = Rig.built(Hidden.THRESHOLD, np.random.default_rng(SEED))
    pressure = np.array([150e3, 300e3, 450e3])
    contraction = np.array([0.03, 0.08, 0.12])
    truth = rig.force(np.arange(3.0), pressure, contraction)
    before = np.asarray(threshold[0].static.force(pressure, contraction))
    version = kept(threshold, tmp_path)
    after = np.asarray(
        load_model(tmp_path / "1.yaml").static.force(pressure, contraction)
    )
    assert np.abs(before - truth).max() > 20
    assert np.abs(after - truth).max() < 4
    assert version.model.static.effects[0].name == "threshold_pressure"


def test_a_version_says_where_it_comes_from(creep: Found, tmp_path: Path) -> None:
    lineage = kept(creep, tmp_path).model.lineage
    assert lineage is not None
    made = lineage.provenance
    assert (made.program, made.seed) == ("0.1.0", SEED)
    assert made.recording.sha256 == creep[1].recording.digest
    assert made.effects[0].name == "creep"
    assert "time_s" in made.effects[0].parameters
    assert made.heldout_runs == creep[1].held_out
    gap = made.gap
    assert gap is not None
    assert (gap.signal, gap.unit) == ("force_N", "N")
    assert gap.rmse_after < gap.rmse_recalibrated < gap.rmse_before


def test_the_covariance_agrees_with_the_standard_deviations(
    creep: Found, tmp_path: Path
) -> None:
    lineage = kept(creep, tmp_path).model.lineage
    assert lineage is not None
    made = lineage.provenance
    assert made.covariance is not None
    (added,) = [one for one in made.effects if one.name == "creep"]
    stds = {f"creep.{key}": std for key, std in added.std.items() if std}
    for one in made.refitted:
        stds[one.name] = one.std[one.name.partition(".")[2]]
    found = dict(zip(made.covariance.parameters, made.covariance.matrix, strict=True))
    assert {"parameter:muscle.diameter_mm", *stds} <= found.keys()
    for index, name in enumerate(found):
        if name in stds:
            std = sqrt(found[name][index])
            assert std == pytest.approx(stds[name], rel=1e-4)


@pytest.mark.parametrize("name", ["threshold", "creep"])
def test_what_was_fitted_together_makes_a_prediction_surer(
    name: str, tmp_path: Path, request: pytest.FixtureRequest
) -> None:
    """Rest length, angle and diameter are doubtful, and the force that was measured is
    not: the noise of a cell, of 3 N, is a quarter of that at the jaws."""
    model = kept(request.getfixturevalue(name), tmp_path).model
    chain = replace(model, linkage=LINKAGE).chain()
    grasp = chain.predict(0.0107, PressedObject(0.06))
    alone = replace(chain, correlations={}).predict(0.0107, PressedObject(0.06))
    assert grasp.grip_std < 3 / 4 < alone.grip_std / 2


def test_a_fitted_parameter_is_known_to_within_its_deviation(
    creep: Found, tmp_path: Path
) -> None:
    tolerances = kept(creep, tmp_path).model.tolerances
    (entry,) = creep[1].named
    fitted = tolerances["effects.creep.time"]
    assert fitted == pytest.approx(entry.parameters["time"].std, rel=1e-4)


def test_no_tolerance_reaches_past_a_bound(creep: Found) -> None:
    model, diagnosis = creep
    (entry,) = diagnosis.named
    wide = {**entry.parameters, "time": Estimate(0.3, 1.0)}
    doubtful = replace(diagnosis, named=(replace(entry, parameters=wide),))
    better = improvement(model, doubtful, "0.1.0")
    assert "effects.creep.time" not in better.model.tolerances


@pytest.mark.parametrize(
    ("value", "tolerance"), [(0.0, None), (0.001, 0.001), (1.999, 0.001)]
)
def test_a_tolerance_ends_where_no_constant_can_be(
    creep: Found, tmp_path: Path, value: float, tolerance: float | None
) -> None:
    model, diagnosis = creep
    version = kept((model, rubbing(diagnosis, value, 0.003)), tmp_path)
    muscle = version.model.static.muscle
    assert muscle.friction_coefficient == pytest.approx(value)
    there = version.model.tolerances.get("muscle.friction_coefficient")
    assert there == (tolerance and pytest.approx(tolerance))


def test_what_is_stated_to_be_exact_stays_so(creep: Found, tmp_path: Path) -> None:
    model, diagnosis = creep
    exact = replace(model, tolerances={**model.tolerances, "muscle.rest_length": 0.0})
    recording, library = diagnosis.recording, {"creep": Creep}
    found = diagnose(recording, model.explanation(), exact.tolerances, library, SEED)
    version = kept((exact, found), tmp_path)
    assert version.model.tolerances["muscle.rest_length"] == 0


def rubbing(diagnosis: Diagnosis, value: float, std: float) -> Diagnosis:
    """Let the coefficient of friction have been fitted so."""
    found, contest = diagnosis.found, diagnosis.contest
    paths = [one.path for one in found.problem.constants]
    index = paths.index("muscle.friction_coefficient")
    listed = list(found.problem.constants)
    listed[index] = replace(listed[index], nominal=0.0, sigma=1.0)
    fit = contest.best.fit
    shifts, told = fit.point.shifts.copy(), fit.information.copy()
    told[index] = told[:, index] = 0.0
    # Beside the tolerance, of 1.
    shifts[index], told[index, index] = value, std**-2 - 1
    fitted = replace(fit, point=replace(fit.point, shifts=shifts), information=told)
    return replace(
        diagnosis,
        found=replace(found, problem=replace(found.problem, constants=tuple(listed))),
        contest=replace(contest, best=replace(contest.best, fit=fitted)),
    )


def test_open_jaws_are_as_wide_as_their_sensor_reads(creep: Found) -> None:
    """Its zero stays out of a version, and what it reads of open jaws is foretold."""
    jawed = replace(creep[0], linkage=LINKAGE)
    told = diagnose(
        with_jaws(recording(lacking(25.0))),
        replace(MODEL, linkage=LINKAGE),
        {},
        {"threshold_pressure": ThresholdPressure},
    )
    problem, best = told.found.problem, told.contest.best
    shifts = best.fit.point.shifts.copy()
    shifts[[one.path for one in problem.constants].index("zero.opening")] = 2.5
    point = replace(best.fit.point, shifts=shifts)
    fitted = replace(best, fit=replace(best.fit, point=point))
    moved = replace(told, contest=replace(told.contest, best=fitted))
    whole = problem.explanation(point)
    assert whole.linkage is not None
    assert whole.zeros[Signal.OPENING] > 1e-4
    better = improvement(jawed, moved, "0.1.0").model.linkage
    assert better is not None
    read = whole.linkage.open_width + whole.zeros[Signal.OPENING]
    assert better.open_width == pytest.approx(read, abs=1e-6)
    # What both are off by together is known far better than either.
    listed = [one.path for one in problem.constants]
    places = [listed.index("gripper.open_width"), listed.index("zero.opening")]
    doubt = best.fit.posterior[np.ix_(places, places)]
    sigmas = [problem.constants[place].sigma for place in places]
    drawn = np.random.default_rng(7).multivariate_normal([0, 0], doubt, 100_000)
    known = improvement(jawed, moved, "0.1.0").model.tolerances
    assert known["gripper.open_width"] == pytest.approx(
        float(np.std(drawn @ sigmas)), rel=0.01
    )


def test_an_effect_of_the_model_gets_the_size_that_was_found(
    creep: Found, tmp_path: Path
) -> None:
    """A threshold of 20 kPa in the model is one of 40 on the rig."""
    effects = (RubberElasticity(), BraidFriction(), ThresholdPressure(pressure=20e3))
    model = replace(creep[0], static=StaticMuscle(MODEL.muscle, effects), tolerances={})
    told = diagnose(
        recording(lacking(40.0)),
        replace(MODEL, effects=effects),
        {},
        {"coulomb_friction": CoulombFriction},
    )
    version = kept((model, told), tmp_path)
    (threshold,) = (
        one
        for one in load_model(tmp_path / "1.yaml").static.effects
        if isinstance(one, ThresholdPressure)
    )
    assert threshold.pressure == pytest.approx(40e3, rel=0.1)
    path = "effects.threshold_pressure.pressure"
    (estimate,) = told.named[0].parameters.values()
    assert version.model.tolerances[path] == pytest.approx(estimate.std, rel=1e-3)
    # Its number is as round as that of any constant.
    assert threshold.pressure == round(threshold.pressure, 2)
    # A wider muscle with more of a threshold pulls as hard.
    known = load_model(tmp_path / "1.yaml").correlations
    assert known["muscle.diameter", path] > 0.1


@pytest.mark.parametrize(
    "verdict", [Verdict.AMBIGUOUS, Verdict.UNEXPLAINED, Verdict.NONE]
)
def test_only_what_is_named_is_added(creep: Found, verdict: Verdict) -> None:
    model, diagnosis = creep
    with pytest.raises(Refused, match=f"the verdict is {verdict}") as refused:
        improvement(model, replace(diagnosis, verdict=verdict), "0.1.0")
    assert refused.value.code == "not-named"


def test_what_held_out_data_do_not_confirm_is_refused(creep: Found) -> None:
    model, diagnosis = creep
    best = diagnosis.contest.best
    too_much = best.fit.point.with_effect(Creep(fast=0.5, medium=0.5, slow=0.5))
    worse = replace(best, fit=replace(best.fit, point=too_much))
    contest = replace(diagnosis.contest, best=worse)
    with pytest.raises(Refused, match="on data that took no part") as refused:
        improvement(model, replace(diagnosis, contest=contest), "0.1.0")
    assert refused.value.code == "not-confirmed"
