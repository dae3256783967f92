"""A regulator that is slower than common ones, told from ramps alone."""

from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.diagnosis import diagnose
from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.readings.recording import Recording
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.found import Found
from gripperd.diagnose.search.quick import with_quick_regulator
from gripperd.diagnose.search.stepwise import search
from gripperd.diagnose.setup import problem_of
from gripperd.diagnose.verdict.conclude import Verdict
from gripperd.effects import EFFECTS
from gripperd.model.effect import Signal
from gripperd.model.track import Array
from tests.diagnose.small import MODEL, REGULATOR
from tests.diagnose.sweep import noise, run

ROW = 0.05
"""Time between rows. [s]"""
FINE = 50
"""Steps of the rig in one row."""
NAMES = ("valve_lag", "valve_dead_band", "valve_gain")


def _asked(fullest: float) -> Array:
    """Up and down as a crank drives it, ever faster, with rests between. [Pa]"""
    parts = []
    for length in (8.0, 4.0, 2.0):
        phase = np.linspace(0.0, np.pi, round(length / ROW) * FINE)
        parts += [np.sin(phase) ** 2 * fullest, np.zeros(40 * FINE)]
    return 30e3 + np.concatenate(parts)


def _recording(lags: tuple[float, float]) -> Recording:
    """Six ramps, whose pressure follows by one lag after another. [s]"""
    runs = []
    for number, fullest in enumerate(np.linspace(200e3, 450e3, 6).tolist()):
        asked = _asked(fullest)
        level = asked
        for late in lags:
            kept = np.exp(-ROW / FINE / late)
            out, last = np.empty_like(level), level[0]
            for index, goal in enumerate(level.tolist()):
                last = goal + (last - goal) * kept
                out[index] = last
            level = out
        read = level[::FINE]
        runs.append(
            run(
                f"{number}",
                time=100.0 * number + ROW * np.arange(float(read.size)),
                current=np.asarray(REGULATOR.current(asked[::FINE])),
                pressure=read + noise(read.size, 2e3, number),
            )
        )
    return Recording("r", "", tuple(runs))


def _searched(problem: Problem) -> Found:
    return search(problem, (), np.random.default_rng(0))


def _never(_: Problem) -> Found:
    pytest.fail("searched again")


@pytest.mark.parametrize(
    ("lags", "told"),
    [((0.008, 0.008), []), ((0.014, 0.008), []), ((0.036, 0.016), ["valve_lag"])],
)
def test_a_lag_beyond_that_of_any_quick_regulator_is_named(
    lags: tuple[float, float], told: list[str]
) -> None:
    """Makers state 25 ms at least, of common ones; twice that is one lag of 52 ms."""
    library = {name: EFFECTS[name] for name in NAMES}
    judged = diagnose(_recording(lags), MODEL, {}, library)
    assert judged.verdict is (Verdict.NAMED if told else Verdict.NONE)
    assert [entry.name for entry in judged.named] == told


def test_beside_a_misfit_a_slow_response_may_stand_for_anything() -> None:
    found = _searched(problem_of(_recording((0.036, 0.016)), MODEL, {}))
    misfit = replace(found.problem, inflations={Signal.PRESSURE: 3.0})
    unexplained = replace(found, problem=misfit)
    assert with_quick_regulator(unexplained, _never) is unexplained


def test_a_quick_regulator_is_not_asked_again() -> None:
    found = _searched(problem_of(_recording((0.014, 0.008)), MODEL, {}))
    assert with_quick_regulator(found, _never) is found


def test_where_no_lag_can_be_named_the_regulator_stays_slow() -> None:
    found = _searched(problem_of(_recording((0.036, 0.016)), MODEL, {}))
    assert with_quick_regulator(found, _searched) is found


@pytest.mark.parametrize(
    ("known", "is_taken"),
    [
        (Candidate("parameter:muscle.diameter", None, 0), True),
        (Candidate("valve_gain", EFFECTS["valve_gain"]()), False),
    ],
)
def test_no_wrong_constant_holds_a_lag_back(
    known: Candidate, *, is_taken: bool
) -> None:
    found = _searched(problem_of(_recording((0.036, 0.016)), MODEL, {}))
    late = Candidate("valve_lag", EFFECTS["valve_lag"]())
    before, after = (
        replace(found, best=replace(found.best, candidates=(one,)))
        for one in (known, late)
    )
    taken = with_quick_regulator(before, lambda _: after)
    assert taken is (after if is_taken else before)
