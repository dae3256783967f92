from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.fit.candidates import WRONG, Candidate
from gripperd.diagnose.fit.polish import polished
from gripperd.diagnose.fit.rival import Rival
from gripperd.diagnose.readings.recording import Kind
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.setup import problem_of
from gripperd.diagnose.verdict.next_experiment import (
    WORTH,
    Proposal,
    _ramp,
    _separations,
    proposal,
)
from gripperd.effects.coulomb_friction import CoulombFriction
from gripperd.effects.creep import Creep
from gripperd.effects.force_sensor_bias import ForceSensorBias
from gripperd.effects.force_sensor_drift import ForceSensorDrift
from gripperd.effects.leak import Leak
from gripperd.effects.presliding_hysteresis import PreslidingHysteresis
from gripperd.effects.threshold_pressure import ThresholdPressure
from gripperd.effects.valve_gain import ValveGain
from gripperd.model.effect import Effect
from gripperd.model.track import Array
from tests.diagnose.small import (
    MODEL,
    STEP,
    Hidden,
    Moment,
    altered,
    moments,
    pinned,
    recording,
    rubbing,
    threshold,
)


def _creeping(moment: Moment) -> Array:
    """A twentieth of the pull comes with a time constant of 20 s."""
    pull = moment.pressure * moment.pull_area
    late = pull.copy()
    for index in range(1, pull.size):
        late[index] = pull[index] + (late[index - 1] - pull[index]) * np.exp(-STEP / 20)
    return 0.05 * (late - pull)


def _problem(hidden: Hidden) -> Problem:
    problem = problem_of(recording(hidden), MODEL, {})
    return pinned(problem, "muscle.diameter", "zero.force")


def _rival(problem: Problem, effect: Effect) -> Rival:
    point = Point(np.zeros(len(problem.constants)), (effect,))
    return Rival((Candidate(effect.name, effect),), polished(problem, point))


def _proposed(hidden: Hidden, one: Effect, other: Effect) -> Proposal:
    problem = _problem(hidden)
    return proposal(problem, _rival(problem, one), _rival(problem, other))


def _column(found: Proposal, name: str) -> Array:
    values = found.plan[name]
    assert isinstance(values, Sequence)
    return np.array(values)


@pytest.fixture(scope="module")
def held() -> Proposal:
    return _proposed(
        _creeping, Creep(fast=0.0, medium=0.02, slow=0.02), ForceSensorDrift(rate=0.01)
    )


@pytest.fixture(scope="module")
def looped() -> Proposal:
    return _proposed(
        rubbing(10.0), CoulombFriction(magnitude=10.0), PreslidingHysteresis(near=10.0)
    )


def test_creep_and_drift_are_told_apart_with_the_length_held(held: Proposal) -> None:
    assert held.kind in (Kind.STEP, Kind.HOLD, Kind.ISOMETRIC)
    assert np.ptp(_column(held, "contraction")) == 0.0
    assert np.ptp(_column(held, "pressure_kPa")) > 50.0


def test_dry_friction_and_memory_are_told_apart_by_minor_loops(
    looped: Proposal,
) -> None:
    way = np.diff(_column(looped, "contraction"))
    assert np.count_nonzero(np.diff(np.sign(way[way != 0]))) >= 3
    assert np.ptp(_column(looped, "pressure_kPa")) == 0.0


def test_it_says_what_it_separates(held: Proposal, looped: Proposal) -> None:
    assert held.why == "separates creep from force sensor drift"
    assert looped.why == "separates coulomb friction from presliding hysteresis"


def test_the_plan_can_be_run_on_the_rig(held: Proposal, looped: Proposal) -> None:
    for found in (held, looped):
        time, pressure, contraction = (
            _column(found, name) for name in ("t_s", "pressure_kPa", "contraction")
        )
        assert time.size == pressure.size == contraction.size
        assert time[0] == 0.0
        assert (np.diff(time) > 0).all()
        assert pressure.min() >= 0.0
        # All of what its regulator gives, or four fifths; noise was read beyond that.
        assert round(float(pressure.max()), 1) in (400.0, 500.0)
        assert contraction.max() <= 0.205


def test_a_muscle_that_was_never_contracted_is_planned_to_be() -> None:
    """By eq. (4) a bore is told from a braid angle by the length alone."""

    def wide(moment: Moment) -> Array:
        return 0.1 * moment.pressure * moment.pull_area

    whole = recording(wide)
    runs = tuple(run for run in whole.runs if run.name in ("vented", "a"))
    problem = problem_of(replace(whole, runs=runs), MODEL, {})
    problem = pinned(problem, "muscle.diameter", "muscle.braid_angle")
    wrong = [f"{WRONG}{one.path}" for one in problem.constants]
    one, other = (
        Rival((Candidate(name, None, place),), polished(problem, freed))
        for place, name in enumerate(wrong)
        for freed in [Point(np.zeros(2), freed=frozenset({place}))]
    )
    found = proposal(problem, one, other)
    assert found.why == "separates a wrong diameter from a wrong braid angle"
    assert _column(found, "contraction").max() == pytest.approx(0.1)


def test_the_plan_says_how_long_the_muscle_is_and_comes_home(held: Proposal) -> None:
    time, pressure, contraction = (
        _column(held, name) for name in ("t_s", "pressure_kPa", "contraction")
    )
    assert (time[-1], pressure[-1], contraction.max()) == (20.0, 0.0, 0.0)
    assert held.title.endswith("at rest length")


def test_the_corners_of_the_plan_are_the_sweep(looped: Proposal) -> None:
    time, way = _column(looped, "t_s"), _column(looped, "contraction")
    speed = np.abs(np.diff(way) / np.diff(time))
    assert time.size < 30
    assert speed.max() < 0.05


def test_what_no_sweep_tells_apart_is_left_to_a_reference() -> None:
    problem = _problem(rubbing(10.0))
    one = _rival(problem, ForceSensorBias(bias=1.0))
    found = proposal(problem, one, one)
    assert found.kind is None
    assert found.plan == {}
    assert found.why.startswith(
        "no sweep that was tried, up to 500 kPa and a contraction of 0.2, tells"
    )
    assert "reference" in found.why


def test_dwells_of_the_past_are_no_part_of_what_is_planned() -> None:
    problem = _problem(rubbing(10.0))
    rivals = (
        _rival(problem, CoulombFriction(magnitude=10.0)),
        _rival(problem, PreslidingHysteresis(near=10.0)),
    )
    dwelt = replace(problem, dwells=problem.blocks[:1])
    assert proposal(dwelt, *rivals) == proposal(problem, *rivals)


def test_a_muscle_that_may_be_slack_is_planned_for_all_the_same() -> None:
    problem = _problem(rubbing(10.0))
    rivals = (
        _rival(problem, CoulombFriction(magnitude=10.0)),
        _rival(problem, PreslidingHysteresis(near=10.0)),
    )
    # A large muscle: below 150 N its force is not told from none.
    slack = replace(problem, slack=150.0)
    found = proposal(slack, *rivals)
    assert found.kind is proposal(problem, *rivals).kind


def _loops_apart(slack: float) -> Proposal:
    """Dry friction from its memory, of a muscle that is slack below so many newtons."""
    problem = _problem(rubbing(10.0))
    rivals = (
        _rival(problem, CoulombFriction(magnitude=10.0)),
        _rival(problem, PreslidingHysteresis(near=10.0)),
    )
    return proposal(replace(problem, slack=slack), *rivals)


def test_no_muscle_is_planned_to_push_that_cannot() -> None:
    """In no sweep at all does it pull with 2 kN."""
    assert _loops_apart(slack=-np.inf).kind is Kind.CYCLE
    assert _loops_apart(slack=2e3).kind is None


def test_a_sweep_that_tells_one_way_round_alone_may_separate() -> None:
    """Where no loop is taut, only what friction does at rest length is seen.

    There its memory can take on the sign of dry friction, but not the other way.
    """
    found = _loops_apart(slack=600.0)
    assert found.kind is Kind.ISOMETRIC
    assert found.why == "may separate coulomb friction from presliding hysteresis"


def test_a_sweep_that_leaves_them_as_near_as_they_are_is_not_planned() -> None:
    """Where much is left that neither is, it would be planned again and again."""
    problem = _problem(rubbing(20.0))
    rivals = (
        _rival(problem, CoulombFriction(magnitude=10.0)),
        _rival(problem, PreslidingHysteresis(near=10.0)),
    )
    near, far = (proposal(problem, *rivals, margin) for margin in (5.0, 5e3))
    assert near.kind is not None
    assert far.kind is None


def test_a_cell_that_would_read_more_than_a_slack_muscle_may_tell() -> None:
    """Up to 60 kPa a threshold leaves it slack, which the rival would not."""
    problem = replace(_problem(threshold(40.0)), slack=60.0)
    rivals = (
        _rival(problem, ThresholdPressure(pressure=20e3)),
        _rival(problem, ForceSensorBias(bias=-30.0)),
    )
    sweep = _ramp(Kind.ISOMETRIC, 60e3, 0.0, 30.0)
    of_threshold, of_bias = _separations(problem, sweep, *rivals)
    assert of_threshold > WORTH
    assert of_bias == 0


def test_a_leak_is_told_from_a_gain_by_a_hold() -> None:
    low = altered(recording(), moments(), "pressure", lambda read: 0.96 * read)
    problem = pinned(problem_of(low, MODEL, {}), "muscle.diameter")
    leak, gain = Leak(rate=2e-3, refill=10.0), ValveGain(error=-0.04)
    found = proposal(problem, _rival(problem, leak), _rival(problem, gain))
    # Nothing but a command that stands still for long lets a leak be seen.
    assert np.ptp(_column(found, "pressure_kPa")) == 0
    assert _column(found, "t_s")[-1] >= 30
