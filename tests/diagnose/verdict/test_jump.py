import numpy as np
import pytest

from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.rivalry import contest
from gripperd.diagnose.search.stepwise import search
from gripperd.diagnose.setup import problem_of
from gripperd.diagnose.verdict.jump import Jump, jump
from gripperd.effects.force_sensor_drift import ForceSensorDrift
from tests.diagnose.small import (
    MODEL,
    Hidden,
    Moment,
    altered,
    moments,
    nothing,
    pinned,
    recording,
)

OPEN = ("muscle.diameter", "zero.force")
LISTED = (Candidate("force_sensor_drift", ForceSensorDrift(rate=0.05)),)
SLIPPED_AT = 300.0


def _slipped(moment: Moment) -> np.ndarray:
    return np.where(moment.time > SLIPPED_AT, -40.0, 0.0)


def _drifted(moment: Moment) -> np.ndarray:
    return -0.08 * moment.time


def _seen(hidden: Hidden) -> tuple[Problem, Jump | None]:
    problem = pinned(problem_of(recording(hidden), MODEL, {}), *OPEN)
    found = search(problem, LISTED, np.random.default_rng(0))
    return problem, jump(found, contest(found, LISTED))


def test_a_mount_that_slipped_once_is_no_drift() -> None:
    problem, seen = _seen(_slipped)
    assert seen is not None
    assert seen.size == pytest.approx(-40.0, abs=4.0)
    before, after = (
        [bool((course.time > t).all()) for course in problem.courses]
        for t in (SLIPPED_AT, seen.at)
    )
    assert before == after


def test_it_slipped_as_well_where_the_clock_began_long_ago() -> None:
    late = altered(recording(_slipped), moments(), "time", lambda time: time + 1.7e9)
    problem = pinned(problem_of(late, MODEL, {}), *OPEN)
    found = search(problem, LISTED, np.random.default_rng(0))
    seen, known = jump(found, contest(found, LISTED)), _seen(_slipped)[1]
    assert seen is not None
    assert known is not None
    assert seen.at == pytest.approx(known.at)
    assert seen.size == pytest.approx(known.size, rel=1e-3)


def test_a_drift_is_no_jump() -> None:
    assert _seen(_drifted)[1] is None


def test_where_nothing_is_named_nothing_jumps() -> None:
    assert _seen(nothing)[1] is None


def test_the_truth_behind_a_jump_is_the_reading_without_it() -> None:
    problem, seen = _seen(_slipped)
    assert seen is not None
    track = problem.tracks(problem.model)[0]
    pull = np.full(track.time.size, 100.0)
    read = seen.along(pull, track, seen.rest())
    assert seen.truth(read, track) == pytest.approx(pull)


def test_what_sensors_drift_is_no_jump(monkeypatch: pytest.MonkeyPatch) -> None:
    # Were it usual that sensors drift by 60 of the 1200 N.
    monkeypatch.setattr("gripperd.diagnose.verdict.jump.SEEN", 0.05)
    assert _seen(_slipped)[1] is None
