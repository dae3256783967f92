from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.diagnosis import diagnose
from gripperd.diagnose.readings.recording import Recording, Run
from gripperd.diagnose.residuals.explanation import AtRest
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.setup import problem_of
from gripperd.diagnose.verdict.conclude import Verdict
from gripperd.effects import EFFECTS
from gripperd.errors import InputError
from gripperd.model.effect import Signal
from gripperd.model.track import Array
from tests.diagnose.held import COMPLIANCE, held
from tests.diagnose.small import (
    LINKAGE,
    MODEL,
    Hidden,
    Moment,
    altered,
    moments,
    nothing,
    recording,
    tabled,
    textbook,
    with_grip,
    without,
)
from tests.diagnose.sweep import noise

ALL = ("vented", "a", "b", "c", "d", "e", "b2", "f")


def _paths(problem: Problem) -> dict[str, float]:
    return {one.path: one.sigma for one in problem.constants}


def test_a_stated_tolerance_is_used(blank: Problem) -> None:
    stated = problem_of(recording(), MODEL, {"muscle.diameter": 1e-6})
    assert _paths(stated)["muscle.diameter"] == 1e-6
    assert _paths(blank)["muscle.diameter"] > 1e-5


def test_every_sweep_without_travel_has_a_sign_at_rest(blank: Problem) -> None:
    still = {i for i, course in enumerate(blank.courses) if course.run not in "def"}
    signs = {f"rest.{i}" for i in still} | {"rest.all"}
    assert {path for path in _paths(blank) if path.startswith("rest.")} == signs


@pytest.mark.parametrize(
    ("compliance", "sign"), [(COMPLIANCE, AtRest.INFLATING), (0.0, AtRest.CARRIED)]
)
def test_what_is_held_by_a_frame_that_yields_turns_its_friction_round(
    compliance: float, sign: AtRest
) -> None:
    assert problem_of(held(compliance), MODEL, {}).model.at_rest is sign


def test_a_rig_that_measures_a_push_is_never_slack(blank: Problem) -> None:
    force = np.concatenate([course.column("force") for course in blank.courses])
    assert force.min() < -50.0
    assert blank.slack == -np.inf


def test_below_the_noise_a_cord_may_be_slack() -> None:
    corded = altered(recording(), ALL, "force", lambda f: np.maximum(f, 0.0) + 0.1)
    problem = problem_of(corded, MODEL, {})
    assert 0 < problem.slack < 30.0
    left = np.concatenate(
        [
            problem.courses[b.course].level("force")[b.good]
            for b in problem.blocks
            if b.signal is Signal.FORCE
        ]
    )
    assert left.min() > problem.slack


def _cord(reading: Callable[[Moment], Array]) -> Hidden:
    """A muscle that cannot push, on a cell that reads so much more than it pulls."""
    return lambda moment: (
        np.maximum(textbook(moment), 0.0) - textbook(moment) + reading(moment)
    )


@pytest.mark.parametrize(
    ("reading", "name", "most"),
    [
        (lambda moment: 40.0 + 0.0 * moment.time, "force_sensor_bias", 40.0),
        (lambda moment: 40.0 * moment.time / 500.0, "force_sensor_drift", 40.0),
        (lambda moment: -60.0 + 0.0 * moment.time, "force_sensor_bias", -60.0),
    ],
)
def test_a_cell_whose_zero_is_off_pulls_at_no_slack_cord(
    reading: Callable[[Moment], Array], name: str, most: float
) -> None:
    told = recording(_cord(reading))
    assert most < problem_of(told, MODEL, {}).slack < most + 35.0
    rivals = (name, "threshold_pressure", "nonlinear_elasticity", "tapered_ends")
    found = diagnose(told, MODEL, {}, {one: EFFECTS[one] for one in rivals})
    assert [entry.name for entry in found.named] == [name]
    assert found.verdict is Verdict.NAMED


@pytest.mark.parametrize(("told", "zero"), [(7, 0.0), (19, 40.0)])
def test_a_few_readings_of_a_slack_cord_tell_a_zero_if_they_stay(
    told: int, zero: float
) -> None:
    """Where the model would push by 20 to 220 N, the less the higher the pressure."""

    def few(run: Run) -> Run:
        moment = moments()[run.name]
        slack = textbook(moment) < -5.0
        if run.name == "c":
            slack[np.flatnonzero(slack)[:told]] = False
        force = np.where(slack, np.nan, run.columns["force"])
        return replace(run, columns={**run.columns, "force": force})

    plain = recording(_cord(lambda moment: 40.0 + 0.0 * moment.time))
    problem = problem_of(replace(plain, runs=tuple(map(few, plain.runs))), MODEL, {})
    assert problem.zero == pytest.approx(zero, abs=4.0)


def test_few_readings_that_stay_where_the_model_stays_tell_no_zero() -> None:
    time = 900.0 + np.arange(12.0)
    vented = {"time": time, "pressure": 0 * time, "contraction": 0.04 + 0 * time}
    force = 40.0 + noise(12, 3.0, 7)
    pulled = [run for run in recording().runs if run.name in "aef"]
    told = Recording("h", "0" * 64, (*pulled, Run("v", {**vented, "force": force})))
    assert problem_of(told, MODEL, {}).zero == 0.0


def test_a_muscle_that_is_held_and_pushes_is_not_slack() -> None:
    """Vented at 4 % of contraction its rubber pushes with one force all the time."""
    time = np.arange(900.0, 930.0, 0.5)
    empty, way = np.zeros(time.size), np.ones(time.size)
    force = textbook(Moment(time, empty, 0.04 + empty, way))
    assert -120.0 < force.min() < -60.0
    columns = {
        "time": time,
        "pressure": empty,
        "contraction": 0.04 + empty,
        "force": force + noise(time.size, 3.0, 7),
    }
    pulled = [run for run in recording(nothing).runs if run.name in "aef"]
    held_down = Recording("held", "0" * 64, (*pulled, Run("pushed", columns)))
    assert problem_of(held_down, MODEL, {}).slack == -np.inf


def test_what_grows_with_the_length_is_no_zero_of_a_cell() -> None:
    stretched = recording(_cord(lambda moment: 20.0 + 300.0 * moment.contraction))
    assert 0 < problem_of(stretched, MODEL, {}).slack < 40.0


def test_neighbours_in_a_table_are_no_repeats_of_each_other() -> None:
    def corded(moment: Moment) -> Array:
        return np.maximum(textbook(moment), 0.0) - textbook(moment)

    problem = problem_of(tabled(corded, size=9), MODEL, {})
    # Steps between points are 300 N and more; their noise is 3 N.
    assert 0 < problem.slack < 0.13 * problem.full_scale[Signal.FORCE]


def _lengths(told: Recording) -> Recording:
    """The same with the length in place of the contraction."""
    runs = [
        Run(
            run.name,
            {
                **{k: v for k, v in run.columns.items() if k != "contraction"},
                "length": 0.25 * (1 - run.columns["contraction"]),
            },
        )
        for run in told.runs
    ]
    return Recording(told.name, told.digest, tuple(runs))


def test_a_recorded_length_is_as_good_as_a_contraction(blank: Problem) -> None:
    problem = problem_of(_lengths(recording()), MODEL, {})
    start = Point(np.zeros(len(blank.constants)))
    assert problem.model.told_length == 0.25
    for one, other in zip(
        problem.residuals(start), blank.residuals(start), strict=True
    ):
        np.testing.assert_allclose(one, other, atol=1e-6)


def test_a_rest_length_that_is_off_shifts_a_length_not_a_contraction() -> None:
    longer = replace(MODEL, muscle=replace(MODEL.muscle, rest_length=0.252))
    by_length = problem_of(_lengths(recording()), longer, {})
    first = by_length.courses[0].level("contraction")
    np.testing.assert_allclose(first, 0.002 / 0.252, atol=5e-4)


def test_without_current_the_valve_is_no_part_of_the_problem() -> None:
    problem = problem_of(without(recording(nothing), "current"), MODEL, {})
    assert problem.signals == (Signal.FORCE,)
    assert not any(p.startswith("response") for p in _paths(problem))


@pytest.mark.parametrize("alone", ["current", "pressure", "force"])
def test_a_column_alone_cannot_be_compared_with_anything(alone: str) -> None:
    columns = {"current", "pressure", "contraction", "force"} - {alone}
    with pytest.raises(InputError):
        problem_of(without(recording(), *columns), MODEL, {})


def test_a_weight_that_is_told_by_its_name_is_a_force() -> None:
    # A stand with weights of 300 N, and no load cell: the number never changes.
    lifted = altered(recording(), ALL, "force", lambda force: 0.0 * force + 300.0)
    problem = problem_of(lifted, MODEL, {})
    assert 0 < problem.noises[Signal.FORCE].std < 300.0


def test_a_recording_in_which_nothing_varies_is_refused() -> None:
    still = recording()
    for column in ("current", "pressure", "contraction", "force"):
        still = altered(still, ALL, column, lambda value: 0.0 * value + 0.012)
    # Nor does a column that was never written.
    still = replace(
        still,
        runs=tuple(
            Run(run.name, {**run.columns, "grip": np.full(len(run), np.nan)})
            for run in still.runs
        ),
    )
    with pytest.raises(InputError, match="small: nothing varies"):
        problem_of(still, MODEL, {})


def test_a_sensor_that_shows_nothing_is_named() -> None:
    dead = altered(recording(), ALL, "pressure", lambda pressure: 0.0 * pressure)
    with pytest.raises(InputError, match="column pressure_kPa is 0 throughout"):
        problem_of(dead, MODEL, {})


def test_readings_that_know_nothing_of_their_neighbours_are_no_measurement() -> None:
    draws = np.random.default_rng(5)
    shuffled = altered(recording(), ALL, "force", draws.permutation)
    with pytest.raises(InputError, match=r"column force_N scatters by \d+") as refused:
        problem_of(shuffled, MODEL, {})
    assert refused.value.key == "force_N"


def test_a_pressure_that_is_held_throughout_is_no_disorder() -> None:
    draws = np.random.default_rng(5)
    held = replace(
        recording(), runs=tuple(r for r in recording().runs if r.name == "d")
    )
    noisy = altered(
        held, ("d",), "pressure", lambda p: 300e3 + draws.normal(0.0, 900.0, p.size)
    )
    problem = problem_of(without(noisy, "current"), MODEL, {})
    assert problem.signals == (Signal.FORCE,)


def _beside(name: str, made: Callable[[Run], Array]) -> Recording:
    """The small recording with one more column."""
    told = recording()
    runs = (
        Run(run.name, {**run.columns, name: made(run)}, run.kind) for run in told.runs
    )
    return replace(told, runs=tuple(runs))


@pytest.mark.parametrize("ratio", [1.0, 1.05, 2.0])
def test_a_length_beside_a_contraction_tells_the_same(ratio: float) -> None:
    told = _beside("length", lambda r: 0.25 * (1.0 - r.columns["contraction"] / ratio))
    if ratio < 1.1:
        problem_of(told, MODEL, {})
        return
    with pytest.raises(InputError, match="goes 2 times as far as the latter"):
        problem_of(told, MODEL, {})


@pytest.mark.parametrize("supply", [6e5, 6e3])
def test_no_muscle_has_more_than_its_supply(supply: float) -> None:
    fed = _beside("supply", lambda r: np.full(len(r), supply))
    if supply > 5e5:
        problem_of(fed, MODEL, {})
        return
    with pytest.raises(InputError, match="supply_kPa is 6 kPa at most, and the muscle"):
        problem_of(fed, MODEL, {})


@pytest.mark.parametrize("shift", [101.3e3, 97e3, 60e3, 20e3])
def test_a_pressure_with_the_atmosphere_in_it_is_absolute(shift: float) -> None:
    told = altered(recording(), ALL, "pressure", lambda pressure: pressure + shift)
    if shift < 90e3:
        problem_of(told, MODEL, {})
        return
    with pytest.raises(InputError, match="is it absolute") as complaint:
        problem_of(told, MODEL, {})
    assert complaint.value.key == "pressure_kPa"


def test_too_few_samples_to_judge_by_are_refused() -> None:
    plain = without(recording(order=("d", "e")), "current")
    few = replace(
        plain,
        runs=tuple(
            Run(run.name, {key: value[::8] for key, value in run.columns.items()})
            for run in plain.runs
        ),
    )
    with pytest.raises(InputError, match="too few samples"):
        problem_of(few, MODEL, {})


@pytest.mark.parametrize(
    ("factor", "cause"),
    [
        pytest.param(-1.0, "is it with the wrong sign, or of another", id="sign"),
        pytest.param(0.2248, "is it in lbf, or of another muscle", id="lbf"),
        pytest.param(0.1020, "is it in kgf, or of another muscle", id="kgf"),
        pytest.param(8.0, "is it of another muscle[?]", id="no unit"),
    ],
)
def test_what_a_column_is_off_by_tells_why(factor: float, cause: str) -> None:
    off = altered(recording(), ALL, "force", lambda force: factor * force)
    with pytest.raises(InputError, match=cause):
        problem_of(off, MODEL, {})


def test_two_processes_set_up_what_one_does() -> None:
    one, two = (problem_of(recording(), MODEL, {}, count) for count in (1, 2))
    assert (one.processes, two.processes) == (1, 2)
    assert two.noises == one.noises
    for mine, theirs in zip(one.measured, two.measured, strict=True):
        np.testing.assert_array_equal(theirs, mine)


def test_no_reading_is_quieter_than_whoever_measured_it_says() -> None:
    plain = recording()
    stated = replace(plain, noise={"force": 30.0, "pressure": 10.0})
    known, told = (problem_of(one, MODEL, {}).noises for one in (plain, stated))
    assert told[Signal.FORCE].std == 30.0
    quiet = known[Signal.PRESSURE].std
    assert told[Signal.PRESSURE].std == pytest.approx(quiet)
    assert quiet > 500.0


def test_nor_is_a_grip_that_is_held_against_a_force() -> None:
    told = replace(with_grip(recording()), noise={"grip": 8.0})
    jawed = replace(MODEL, linkage=LINKAGE)
    assert problem_of(told, jawed, {}).noises[Signal.GRIP].std == 8.0
