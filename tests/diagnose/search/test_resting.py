from functools import partial

import numpy as np
import pytest

from gripperd.diagnose.fit.candidates import candidates
from gripperd.diagnose.readings.recording import Recording
from gripperd.diagnose.residuals.explanation import AtRest
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.resting import with_resting_sign
from gripperd.diagnose.setup import problem_of
from gripperd.effects import EFFECTS
from gripperd.model.track import Array
from tests.diagnose.small import (
    MODEL,
    Hidden,
    Moment,
    altered,
    nothing,
    recording,
    without,
)

COLUMNS = frozenset({"time", "current", "pressure", "contraction", "force"})
LIBRARY = {name: EFFECTS[name] for name in ("coulomb_friction", "force_sensor_bias")}


def _decided(told: Recording) -> tuple[Problem, Problem]:
    problem = problem_of(told, MODEL, {})
    listed, _ = candidates(LIBRARY, problem, COLUMNS)
    return problem, with_resting_sign(problem, listed)


def _turning(moment: Moment) -> Array:
    """Friction that is against the pressure where nothing travels: 25 N."""
    if np.ptp(moment.contraction) > 0:
        return -25.0 * moment.direction
    rises = np.gradient(moment.pressure) >= 0
    return np.where(rises, -25.0, 25.0)


def _carried(moment: Moment) -> Array:
    return -25.0 * moment.direction


@pytest.mark.parametrize(
    ("hidden", "sign"),
    [
        pytest.param(_turning, AtRest.INFLATING, id="turns with the pressure"),
        pytest.param(_carried, AtRest.CARRIED, id="stays as it came"),
        pytest.param(nothing, AtRest.CARRIED, id="little friction"),
    ],
)
def test_the_convention_that_the_data_support_is_taken(
    hidden: Hidden, sign: AtRest
) -> None:
    _, decided = _decided(recording(hidden))
    assert decided.model.at_rest is sign


def test_a_cell_that_is_late_is_no_friction_that_turns_with_the_pressure() -> None:
    """Both open a loop of the same height in sweeps at rest."""
    plain = recording()
    times = {run.name: run.columns["time"] for run in plain.runs}
    late = plain
    for name, time in times.items():
        late = altered(late, [name], "force", partial(_shifted, time))
    known = LIBRARY | {"channel_delay": EFFECTS["channel_delay"]}
    problem = problem_of(late, MODEL, {})
    listed, _ = candidates(known, problem, COLUMNS)
    assert with_resting_sign(problem, listed).model.at_rest is AtRest.CARRIED
    # Without that name for it, the loop is friction.
    few = [one for one in listed if one.name != "channel_delay"]
    assert with_resting_sign(problem, few).model.at_rest is AtRest.INFLATING


def test_a_valve_that_is_slow_says_nothing_of_friction() -> None:
    slow = recording()
    times = {run.name: run.columns["time"] for run in slow.runs}
    for name, time in times.items():
        slow = altered(slow, [name], "current", partial(_early, time))
    problem = problem_of(slow, MODEL, {})
    known = {"channel_delay": EFFECTS["channel_delay"]}
    listed, _ = candidates(known, problem, COLUMNS)
    assert with_resting_sign(problem, listed).model.at_rest is AtRest.CARRIED


def _shifted(time: Array, force: Array) -> Array:
    return np.interp(time - 0.3, time, force)


def _early(time: Array, current: Array) -> Array:
    return np.interp(time + 1.0, time, current)


def test_nothing_else_of_the_problem_changes() -> None:
    problem, decided = _decided(recording(_turning))
    assert decided.constants == problem.constants
    assert decided.noises == problem.noises
    assert decided.courses is problem.courses


def test_without_a_sweep_at_rest_there_is_nothing_to_decide() -> None:
    moving = without(recording(_turning), "current")
    moving = Recording("m", "0", tuple(r for r in moving.runs if r.name in "def"))
    problem, decided = _decided(moving)
    assert decided is problem
