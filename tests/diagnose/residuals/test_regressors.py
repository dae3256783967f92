from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.readings.columns import BY_QUANTITY
from gripperd.diagnose.residuals.holdout import split
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.residuals.regressors import (
    REGRESSORS,
    inputs,
    level,
    ranges,
    varied,
)
from gripperd.model.effect import Signal


@pytest.fixture(scope="module")
def force(blank: Problem) -> Problem:
    return replace(blank, noises={Signal.FORCE: blank.noises[Signal.FORCE]})


def test_what_was_not_measured_is_no_regressor(force: Problem) -> None:
    parts = split(force)
    found = varied(parts.train, parts.test, REGRESSORS[Signal.FORCE])
    assert {one.quantity for one in found} == {
        "pressure", "contraction", "direction", "rate", "time",
    }  # fmt: skip


def test_what_was_not_varied_is_no_regressor(force: Problem) -> None:
    still = tuple(
        replace(course, direction=np.ones_like(course.time)) for course in force.courses
    )
    parts = split(replace(force, courses=still))
    found = varied(parts.train, parts.test, REGRESSORS[Signal.FORCE])
    assert "direction" not in {one.quantity for one in found}


def test_what_was_measured_in_some_sweeps_alone_has_a_range(force: Problem) -> None:
    first, *rest = force.courses
    warm = np.linspace(293.0, 296.0, first.time.size)
    one = replace(first, measured={**first.measured, "temperature": warm})
    listed = [BY_QUANTITY[name] for name in ("temperature", "supply")]
    found = ranges(replace(force, courses=(one, *rest)), listed)
    ends = found[BY_QUANTITY["temperature"]]
    assert ends == pytest.approx((293.0, 296.0), abs=0.2)
    assert BY_QUANTITY["supply"] not in found
    assert ranges(force, []) == {}


def test_there_is_a_row_for_every_sample_to_explain(force: Problem) -> None:
    found = inputs(force, REGRESSORS[Signal.FORCE])
    assert len(found) == sum(measured.size for measured in force.measured)


def test_time_starts_anew_with_every_sweep(force: Problem) -> None:
    for course in force.courses:
        time = level(course, "time")
        assert (time[0], time[-1]) == (0.0, course.time[-1] - course.time[0])


def test_the_rate_is_that_of_the_travel(force: Problem) -> None:
    # There and back over 0.2 in 25 s.
    (isobar,) = (course for course in force.courses if course.run == "d")
    rate = level(isobar, "rate")
    assert rate[20:30] == pytest.approx(0.2 / 12.5, rel=0.1)
    assert rate[70:80] == pytest.approx(-0.2 / 12.5, rel=0.1)
