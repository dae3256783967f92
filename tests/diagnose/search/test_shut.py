"""Which holds a shut valve leaves alone, where what the others lose does not tell."""

from collections.abc import Mapping

import numpy as np
import pytest

from gripperd.diagnose.diagnosis import diagnose
from gripperd.diagnose.fit.candidates import candidates
from gripperd.diagnose.readings.recording import Recording, Run
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.shut import with_valve_shut
from gripperd.diagnose.setup import problem_of
from gripperd.effects import EFFECTS
from gripperd.model.track import Array
from tests.diagnose.small import MODEL

STEP, PACE = 0.5, 3.5e-4
NOISE = 600.0
COLUMNS = frozenset({"time", "current", "pressure"})


def _hold(level: float, seconds: float, pace: float = 0.0) -> Array:
    time = STEP * np.arange(seconds / STEP)
    return np.asarray(level * np.exp(-pace * time))


def _sweep() -> Array:
    return np.asarray(500e3 * (1 - np.abs(np.linspace(-1.0, 1.0, 60))))


def _recording(pressures: Mapping[str, Array]) -> Recording:
    rng = np.random.default_rng(7)
    runs, start = [], 0.0
    for name, pressure in pressures.items():
        time = start + STEP * np.arange(float(pressure.size))
        told = pressure if name.startswith("sweep") else pressure[0] + 0 * pressure
        columns = {
            "time": time,
            "current": 0.004 + 0.016 * told / 500e3,
            "pressure": pressure + rng.normal(0.0, NOISE, time.size),
        }
        runs.append(Run(name, columns))
        start = time[-1] + 60.0
    return Recording("r", "0" * 64, tuple(runs))


def _problem(pressures: Mapping[str, Array]) -> Problem:
    return problem_of(_recording(pressures), MODEL, {})


def _decided(problem: Problem, *known: str) -> dict[str, Array]:
    library = {name: EFFECTS[name] for name in known}
    listed, _ = candidates(library, problem, COLUMNS)
    courses = with_valve_shut(problem, listed).courses
    return {course.run: course.waiting for course in courses}


HELD = {
    "sweep_1": _sweep(),
    "shut": _hold(370e3, 100.0, PACE),
    "low": _hold(200e3, 80.0, PACE),
    "held": _hold(345e3, 90.0),
    "sweep_2": _sweep(),
}


def test_a_hold_that_a_leak_does_not_fit_was_kept() -> None:
    """It would lose 11 kPa, of which a sensor may drift half."""
    problem = _problem(HELD)
    assert all(course.waiting.any() for course in problem.courses)
    waits = _decided(problem, "leak")
    assert not waits["held"].any()
    np.testing.assert_allclose(waits["shut"], STEP * np.arange(200), atol=1.0)


def test_a_diagnosis_goes_by_it_in_what_was_left_out_as_well() -> None:
    told = diagnose(_recording(HELD), MODEL, {}, {"leak": EFFECTS["leak"]})
    assert [entry.name for entry in told.named] == ["leak"]
    for part in (told.split.train, told.split.test):
        (held,) = (one for one in part.courses if one.run == "held")
        assert not held.waiting.any()


@pytest.mark.parametrize(
    ("pressures", "known"),
    [
        pytest.param(HELD, "valve_lag", id="no leak to be found"),
        pytest.param(
            HELD | {"shut": _hold(370e3, 100.0), "low": _hold(200e3, 80.0)},
            "leak",
            id="nothing sinks",
        ),
        pytest.param(
            HELD | {"held": _hold(345e3, 90.0, PACE)}, "leak", id="everything sinks"
        ),
    ],
)
def test_otherwise_it_stays_as_it_was(
    pressures: Mapping[str, Array], known: str
) -> None:
    problem = _problem(pressures)
    waits = _decided(problem, known)
    for course in problem.courses:
        np.testing.assert_array_equal(waits[course.run], course.waiting)


def _fed(level: float, seconds: float) -> Array:
    """A leak that a regulator makes up for within 20 s, solved as it is told."""
    pace, time = 2.5e-3, STEP * np.arange(seconds / STEP)
    share = pace + 1 / 20.0
    return np.asarray(level * (1 - pace / share * (1 - np.exp(-share * time))))


def test_a_hold_that_sinks_as_a_slow_regulator_lets_it_is_not_shut() -> None:
    problem = _problem({
        "sweep_1": _sweep(),
        "fed_1": _fed(370e3, 40.0),
        "shut": _hold(350e3, 60.0, 2.5e-3),
        "fed_2": _fed(300e3, 30.0),
        "sweep_2": _sweep(),
    })  # fmt: skip
    waits = _decided(problem, "leak")
    assert waits["shut"].any()
    assert not waits["fed_1"].any()
    assert not waits["fed_2"].any()
