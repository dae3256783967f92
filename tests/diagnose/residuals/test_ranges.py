"""Ranges of sensors, and of those behind them."""

from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.readings.recording import Recording, Run
from gripperd.diagnose.residuals.ranges import ranges
from gripperd.diagnose.setup import problem_of
from gripperd.model.effect import Signal
from tests.diagnose.small import LINKAGE, MODEL, recording, with_grip, with_jaws

JAWED = replace(MODEL, linkage=LINKAGE)


def _where_jaws_are(told: Recording) -> Recording:
    """Jaws in one sweep alone, which goes less far than the others."""
    runs = [
        run if run.name == "b" else Run(run.name, _without(run), run.kind)
        for run in told.runs
    ]
    return replace(told, runs=tuple(runs))


def _without(run: Run) -> dict[str, np.ndarray]:
    nothing = np.full(len(run), np.nan)
    return {**run.columns, "opening": nothing, "grip": nothing}


def test_what_is_foretold_from_another_reading_is_as_far_off_as_that() -> None:
    told = _where_jaws_are(with_jaws(with_grip(recording())))
    problem = problem_of(told, JAWED, {})
    scales, found = problem.full_scale, ranges(problem)
    furthest = max(
        float(np.max(course.level("contraction"))) for course in problem.courses
    )
    # The jaws close 4 mm for one of the muscle, of 250 mm, and it pulls four times.
    assert found[Signal.OPENING] == pytest.approx(
        scales[Signal.OPENING] + furthest * 1.0, rel=1e-6
    )
    assert found[Signal.GRIP] == pytest.approx(
        scales[Signal.GRIP] + scales[Signal.FORCE] / 4
    )
    for signal in (Signal.PRESSURE, Signal.FORCE):
        assert found[signal] == scales[signal]


def test_without_jaws_each_sensor_stands_for_itself() -> None:
    problem = problem_of(recording(), MODEL, {})
    assert ranges(problem) == problem.full_scale
