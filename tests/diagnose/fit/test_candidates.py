from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from gripperd.diagnose.fit.candidates import (
    KEPT,
    Candidate,
    amplitudes,
    candidates,
    forms,
    is_exact,
    is_plain,
    side,
)
from gripperd.diagnose.fit.design import limits
from gripperd.diagnose.readings.course import is_table
from gripperd.diagnose.readings.recording import Run
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.setup import problem_of
from gripperd.effects import EFFECTS
from gripperd.effects.channel_delay import ChannelDelay
from gripperd.effects.creep import Creep, Creeping
from gripperd.effects.pressure_friction import PressureFriction
from gripperd.effects.threshold_pressure import ThresholdPressure
from gripperd.effects.valve_offset import ValveOffset, Zero
from gripperd.model.effect import Effect, Signal, Stage
from gripperd.model.parameter import in_use, parameters
from tests.diagnose.small import MODEL, nothing, recording, tabled, without

MEASURED = frozenset({"time", "current", "pressure", "contraction", "force"})


def _names(listed: tuple[Candidate, ...]) -> set[str]:
    return {one.name for one in listed}


def test_everything_is_either_a_candidate_or_unseen_or_in_the_model(
    blank: Problem,
) -> None:
    listed, unseen = candidates(EFFECTS, blank, MEASURED)
    present = {effect.name for effect in MODEL.effects}
    effects = {one.name for one in listed if one.effect}
    assert effects | set(unseen) | present == set(EFFECTS)
    assert not effects & set(unseen)
    assert not present & (effects | set(unseen))


@pytest.mark.parametrize(
    ("effect", "is_told"),
    [
        pytest.param(Creep(fast=-0.02, time=40.0), True, id="a form of its own"),
        pytest.param(ThresholdPressure(pressure=20e3), False, id="as it begins"),
    ],
)
def test_a_form_that_the_model_has_is_told_to_be_kept(
    blank: Problem, effect: Effect, *, is_told: bool
) -> None:
    model = blank.model.with_effect(effect)
    listed, unseen = candidates(EFFECTS, replace(blank, model=model), MEASURED)
    assert effect.name not in _names(listed)
    assert (unseen.get(effect.name) == KEPT) is is_told


def test_what_needs_a_column_that_is_missing_says_which(blank: Problem) -> None:
    listed, unseen = candidates(EFFECTS, blank, MEASURED)
    assert "temperature_stiffness" not in _names(listed)
    assert unseen["temperature_stiffness"] == "temperature not measured"


@pytest.mark.parametrize(
    ("further", "basis"),
    [
        ("nonlinear_elasticity", "rubber_elasticity"),
        ("pressure_friction", "braid_friction"),
    ],
)
def test_where_the_model_lacks_the_textbook_nothing_departs_from_it(
    blank: Problem, further: str, basis: str
) -> None:
    bare = replace(blank, model=replace(MODEL, effects=()))
    listed, unseen = candidates(EFFECTS, bare, MEASURED)
    assert basis in _names(listed)
    assert unseen[further] == f"{basis} is not in the model"
    assert further in _names(candidates(EFFECTS, blank, MEASURED)[0])


def test_the_valve_is_not_suspected_where_its_pressure_is_not_predicted() -> None:
    problem = _without_current()
    listed, _ = candidates(EFFECTS, problem, MEASURED - {"current"})
    stages = {one.effect.stage for one in listed if one.effect}
    assert stages == {Stage.MUSCLE, Stage.SENSOR, Stage.GRIPPER}


def _without_current() -> Problem:
    return problem_of(without(recording(), "current"), MODEL, {})


def test_constants_of_the_model_are_candidates_those_of_the_sensors_are_not(
    blank: Problem,
) -> None:
    listed, _ = candidates({}, blank, MEASURED)
    names = _names(listed)
    assert "parameter:muscle.diameter" in names
    assert "parameter:valve.pressure_high" in names
    assert {name.partition(".")[0] for name in names} == {
        "parameter:muscle",
        "parameter:valve",
    }
    for one in listed:
        assert one.constant is not None
        assert one.name.endswith(blank.constants[one.constant].path)
        assert one.stage == "-"


def test_an_effect_that_the_model_has_is_no_candidate() -> None:
    model = replace(MODEL, effects=(*MODEL.effects, ThresholdPressure()))
    problem = problem_of(recording(), model, {})
    listed, unseen = candidates(EFFECTS, problem, MEASURED)
    assert "threshold_pressure" not in _names(listed) | set(unseen)


@pytest.mark.parametrize("name", EFFECTS)
def test_the_forms_of_an_effect_are_all_combinations_of_its_starts(name: str) -> None:
    known = parameters(EFFECTS[name])
    wanted = 2 if EFFECTS[name].one_sided else 1
    for one in known.values():
        wanted *= len(one.starts or one.choices or (None,))
    # Of the three that may creep, only the pull has two leverages.
    wanted -= wanted // 3 if name == "creep" else 0
    # Only what trails has a spread, and only what wakes a speed.
    wanted = 2 + 1 + 2 if name == "valve_dead_band" else wanted
    # Only a regulator that suppresses its zero brings its offset by and by, or in part.
    wanted = 1 + 2 * 2 if name == "valve_offset" else wanted
    # Joints turn over a change of the pull or over a way, not over both.
    wanted = 2 + 2 if name == "linkage_friction" else wanted
    # Springs alone have a distance and one sign, relays alone a middle and a curve.
    wanted = 3 + 2 * (2 * 2) if name == "presliding_hysteresis" else wanted
    wanted = 2 * (3 + 2 * (2 * 2)) if name == "pressure_hysteresis" else wanted
    found = forms(EFFECTS[name])
    assert len(set(found)) == len(found) == wanted


@pytest.mark.parametrize("name", EFFECTS)
def test_every_form_acts_within_its_bounds(name: str) -> None:
    for form in forms(EFFECTS[name]):
        for field, one in parameters(form).items():
            if one.choices:
                continue
            value = getattr(form, field)
            assert one.low <= value <= one.high
            is_used = field in in_use(form, form.idle)
            assert (value != 0) == is_used or not one.is_amplitude


def test_a_one_sided_effect_is_tried_to_either_side_and_stays_there(
    blank: Problem,
) -> None:
    sides = {1: 0, -1: 0}
    for form in forms(Creep):
        sizes = {getattr(form, name) > 0 for name in amplitudes(form)}
        assert len(sizes) == 1
        sides[side(form)] += 1
        low, high = limits(blank, form, "slow")
        assert (low, high) == ((0.0, 0.15) if side(form) > 0 else (-0.15, 0.0))
    assert sides[1] == sides[-1] == len(forms(Creep)) / 2


def test_amplitudes_are_what_an_effect_is_proportional_to() -> None:
    assert amplitudes(Creep()) == ["fast", "medium", "slow"]
    assert amplitudes(ThresholdPressure()) == ["pressure"]


@pytest.mark.parametrize(
    ("name", "exact"),
    [
        ("force_sensor_bias", True),
        ("pressure_sensor_gain", True),
        ("force_sensor_drift", True),
        ("valve_offset", True),
        ("creep", False),
        ("threshold_pressure", False),
        ("coulomb_friction", False),
    ],
)
def test_what_a_sensor_does_has_no_form_but_ours(name: str, exact: bool) -> None:
    assert is_exact(Candidate(name, forms(EFFECTS[name])[0])) is exact


def test_an_offset_that_comes_by_and_by_has_a_form() -> None:
    at_once, faded = (
        ValveOffset(offset=5e3, fade=fade, zero=Zero.SUPPRESSED) for fade in (0.0, 1e4)
    )
    assert is_exact(Candidate("valve_offset", at_once))
    assert not is_exact(Candidate("valve_offset", faded))


def test_a_constant_has_no_form() -> None:
    assert not is_exact(Candidate("parameter:muscle.diameter", None, 0))


def test_a_constant_that_is_wrong_as_an_effect_shows_is_left_to_the_effect(
    blank: Problem,
) -> None:
    low, high = "parameter:valve.pressure_low", "parameter:valve.pressure_high"
    for library, names in (
        ({}, {low, high}),
        ({"valve_gain": EFFECTS["valve_gain"]}, {low}),
        ({"valve_offset": EFFECTS["valve_offset"]}, {high}),
        (EFFECTS, set()),
    ):
        listed, _ = candidates(library, blank, MEASURED)
        assert _names(listed) & {low, high} == names


def test_channels_that_are_late_are_candidates_of_several_kinds() -> None:
    kinds = {
        Candidate("channel_delay", ChannelDelay(delay=0.1, channel=channel)).kind
        for channel in (Signal.FORCE, Signal.CONTRACTION)
    }
    assert kinds == {("channel_delay", "force"), ("channel_delay", "contraction")}
    creeps = {Candidate("creep", form).kind for form in forms(Creep)}
    assert creeps == set(product(["creep"], Creeping))


def test_rubber_that_creeps_is_no_candidate_without_rubber(blank: Problem) -> None:
    """It would stand in for the rubber itself."""
    bare = replace(blank, model=replace(MODEL, effects=()))
    plain = {"pull", "pressure"}
    for problem, known in ((blank, plain | {"rubber"}), (bare, plain)):
        listed, _ = candidates({"creep": Creep}, problem, MEASURED)
        assert {one.kind[1] for one in listed if one.name == "creep"} == known


def test_a_pressure_that_creeps_is_no_candidate_where_nothing_travels(
    blank: Problem,
) -> None:
    """It is told from a pull that creeps by nothing but a travel."""
    still = [course for course in blank.courses if not course.direction.any()]
    held = replace(blank, courses=tuple(still))
    listed, _ = candidates({"creep": Creep}, held, MEASURED)
    assert {one.kind[1] for one in listed if one.name == "creep"} == {"pull", "rubber"}


def test_no_form_that_remembers_is_a_candidate_in_a_table() -> None:
    """Points that were numbered have no way over which a friction could turn round."""
    there = np.linspace(0.0, 0.2, 20)
    away = {"contraction": np.concatenate((there, there[::-1]))}
    told = tabled(nothing)
    runs = tuple(replace(run, columns={**run.columns, **away}) for run in told.runs)
    problem = problem_of(replace(told, runs=runs), MODEL, {})
    friction = {"pressure_friction": PressureFriction}
    listed, _ = candidates(friction, problem, MEASURED - {"current"})
    tried = {
        one.effect.distance
        for one in listed
        if isinstance(one.effect, PressureFriction)
    }
    assert is_table(problem.courses)
    assert tried == {0.0}


def test_what_acts_on_a_signal_that_nothing_shows_says_so(blank: Problem) -> None:
    courses = tuple(
        replace(one, measured={k: v for k, v in one.measured.items() if k != "force"})
        for one in blank.courses
    )
    listed, unseen = candidates(EFFECTS, replace(blank, courses=courses), MEASURED)
    assert "threshold_pressure" not in _names(listed)
    assert unseen["threshold_pressure"] == "no sample of the force can be compared"
    assert "valve_gain" in _names(listed)


@pytest.mark.parametrize(
    ("name", "plain"),
    [
        ("force_sensor_gain", True),
        ("pressure_sensor_bias", True),
        ("length_datum", True),
        ("valve_gain", True),
        ("valve_offset", True),
        ("force_sensor_drift", False),
        ("channel_delay", False),
        ("valve_lag", False),
        ("rubber_elasticity", False),
    ],
)
def test_an_offset_or_a_factor_is_plain(name: str, *, plain: bool) -> None:
    assert is_plain(Candidate(name, EFFECTS[name]())) is plain


def test_a_wrong_constant_is_no_plain_effect() -> None:
    assert not is_plain(Candidate("parameter:muscle.diameter", None, 0))


def _halved(*back: str) -> Problem:
    """The way there of each sweep, and of some the way back."""
    plain = recording()
    runs = []
    for run in plain.runs:
        half = len(run) // 2
        rows = slice(half, None) if run.name in back else slice(half)
        columns = {name: column[rows] for name, column in run.columns.items()}
        runs.append(Run(run.name, columns))
    return problem_of(replace(plain, runs=tuple(runs)), MODEL, {})


def test_no_loop_is_told_of_what_never_turned() -> None:
    _, unseen = candidates(EFFECTS, _halved(), MEASURED)
    assert unseen["pressure_hysteresis"] == "the pressure never went both ways"
    assert unseen["valve_dead_band"] == "the current never went both ways"
    assert unseen["coulomb_friction"] == "the length never went both ways"


def test_a_way_back_may_have_a_sweep_of_its_own() -> None:
    listed, _ = candidates(EFFECTS, _halved("b2", "e"), MEASURED)
    assert {"pressure_hysteresis", "valve_dead_band", "coulomb_friction"} <= _names(
        listed
    )
