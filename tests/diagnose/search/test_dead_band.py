"""A regulator that sleeps, written from its description."""

import numpy as np
import pytest

from gripperd.diagnose.diagnosis import diagnose
from gripperd.diagnose.fit.candidates import candidates
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.dead_band import with_dead_band
from gripperd.diagnose.setup import problem_of
from gripperd.diagnose.statement import statement
from gripperd.diagnose.verdict.conclude import Verdict, conclude
from gripperd.effects import EFFECTS
from gripperd.effects.valve_dead_band import ValveDeadBand
from gripperd.model.effect import Signal
from tests.diagnose.sleeping import (
    NOISE,
    Spool,
    commands,
    doubled,
    ladders,
    rounds,
    sleeps,
    sticks,
    stuck,
    trails,
)
from tests.diagnose.small import MODEL

COLUMNS = frozenset({"time", "current", "pressure"})
BAND = 25e3
VALVES = {
    name: EFFECTS[name]
    for name in (
        "valve_dead_band", "valve_lag", "valve_nonlinearity", "valve_offset",
        "valve_gain", "supply_saturation", "channel_delay",
    )
}  # fmt: skip


def _read(spool: Spool, *known: str) -> Problem:
    problem = problem_of(stuck(spool, BAND), MODEL, {})
    library = {name: EFFECTS[name] for name in known}
    return with_dead_band(problem, candidates(library, problem, COLUMNS)[0])


def test_a_band_in_which_a_regulator_sleeps_is_told() -> None:
    told = _read(sleeps, "valve_dead_band")
    # It is up to a band behind its command, and right there when it has caught up.
    assert 0.6 * BAND < told.band < 1.2 * BAND
    assert told.noises[Signal.PRESSURE].std == pytest.approx(NOISE, rel=0.1)


@pytest.mark.parametrize("spool", [trails, sticks])
def test_a_spool_that_follows_once_it_is_loose_does_not_sleep(spool: Spool) -> None:
    assert _read(spool, "valve_dead_band").band == 0.0


def test_stairs_that_are_the_same_on_the_way_back_are_no_sleep() -> None:
    """A set point that is rounded knows no way, and a dead band explains none of it."""
    assert _read(rounds, "valve_dead_band").band == 0.0


def test_a_band_that_nothing_could_name_is_none() -> None:
    assert _read(sleeps, "valve_lag").band == 0.0


@pytest.mark.parametrize("spool", [sleeps, trails, sticks])
def test_a_dead_band_is_named_however_a_spool_leaves_it(spool: Spool) -> None:
    told = diagnose(stuck(spool, BAND), MODEL, {}, VALVES)
    assert told.verdict is Verdict.NAMED
    (entry,) = told.named
    assert entry.name == "valve_dead_band"
    gap = told.gaps[Signal.PRESSURE]
    if spool is not sleeps:
        assert gap.after < min(1.3 * NOISE, 0.6 * gap.recalibrated)
    assert ("sleeps" in statement(told, entry)) is (spool is sleeps)


def test_what_lies_within_the_band_is_not_held_against_what_is_named() -> None:
    told = diagnose(
        stuck(sleeps, BAND), MODEL, {}, {"valve_dead_band": EFFECTS["valve_dead_band"]}
    )
    residual = np.concatenate(told.split.train.residuals(told.explained))
    assert np.std(residual) > 2 * NOISE
    assert conclude(told.split.train, told.found, told.contest).signals == ()


@pytest.mark.parametrize("band", [9e3, 11e3, 15e3])
def test_which_treads_one_that_rests_on_each_will_follow_is_foretold(
    band: float,
) -> None:
    told = diagnose(stuck(sleeps, band, asked=ladders()), MODEL, {}, VALVES)
    assert [entry.name for entry in told.named] == ["valve_dead_band"]
    assert told.verdict is Verdict.NAMED
    assert told.split.train.band == 0.0
    gap = told.gaps[Signal.PRESSURE]
    assert gap.after < min(1.3 * NOISE, 0.8 * gap.recalibrated)


def test_a_band_far_from_the_usual_is_found() -> None:
    told = diagnose(stuck(sleeps, 6e3, asked=ladders()), MODEL, {}, VALVES)
    (effect,) = told.explained.effects[-1:]
    assert isinstance(effect, ValveDeadBand)
    assert effect.width == pytest.approx(6e3, rel=0.1)


def test_a_band_that_is_left_little_by_little_is_foretold() -> None:
    told = diagnose(stuck(doubled, 60e3, asked=commands()), MODEL, {}, VALVES)
    assert [entry.name for entry in told.named] == ["valve_dead_band"]
    assert told.verdict is Verdict.NAMED
    gap = told.gaps[Signal.PRESSURE]
    assert gap.after < 1.05 * NOISE
