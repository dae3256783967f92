from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.candidates import Candidate
from gripperd.diagnose.constants import Constant
from gripperd.diagnose.polish import polished
from gripperd.diagnose.problem import Point, Problem
from gripperd.diagnose.search import Found, Rival, acts_on, added, search
from gripperd.diagnose.setup import problem_of
from gripperd.effects.coulomb_friction import CoulombFriction
from gripperd.effects.force_sensor_bias import ForceSensorBias
from gripperd.effects.pressure_sensor_bias import PressureSensorBias
from gripperd.effects.threshold_pressure import ThresholdPressure
from gripperd.effects.valve_offset import ValveOffset
from gripperd.model.effect import Signal
from gripperd.model.track import Array
from tests.diagnose.small import (
    MODEL,
    Hidden,
    Moment,
    covariance,
    nothing,
    pinned,
    recording,
    rubbing,
    threshold,
)

LISTED = (
    Candidate("threshold_pressure", ThresholdPressure(pressure=20e3)),
    Candidate("coulomb_friction", CoulombFriction(magnitude=20.0)),
    Candidate("force_sensor_bias", ForceSensorBias(bias=5.0)),
)
OPEN = ("muscle.diameter", "muscle.elastic_modulus", "zero.force")
INERT = Constant("gripper.open_width", 0.085, 1e-3, stated=False)
"""Of a part that this rig has not: it changes nothing."""


def _found(hidden: Hidden, seed: int = 0) -> Found:
    problem = pinned(problem_of(recording(hidden), MODEL, {}), *OPEN)
    return search(problem, LISTED, np.random.default_rng(seed))


def _both(moment: Moment) -> Array:
    return threshold(30.0)(moment) + rubbing(25.0)(moment)


@pytest.fixture(scope="module")
def late() -> Found:
    return _found(threshold(25.0))


def test_where_nothing_is_hidden_nothing_is_found() -> None:
    found = _found(nothing)
    assert found.best is found.null
    assert found.best.names == ()
    assert max(found.gains.values()) < found.threshold


@pytest.mark.parametrize(
    ("hidden", "names"),
    [
        pytest.param(rubbing(20.0), {"coulomb_friction"}, id="friction"),
        pytest.param(lambda m: 25.0 + 0 * m.time, {"force_sensor_bias"}, id="bias"),
        pytest.param(_both, {"threshold_pressure", "coulomb_friction"}, id="two"),
    ],
)
def test_what_is_hidden_is_found(hidden: Hidden, names: set[str]) -> None:
    assert set(_found(hidden).best.names) == names


def test_the_best_has_paid_its_price(late: Found) -> None:
    assert late.best.names == ("threshold_pressure",)
    assert late.best.evidence - late.null.evidence > late.threshold
    assert late.gains["threshold_pressure"] == max(late.gains.values())


def test_rivals_come_best_first_and_the_model_itself_is_one(late: Found) -> None:
    evidence = [rival.evidence for rival in late.rivals]
    assert evidence == sorted(evidence, reverse=True)
    assert late.null in late.rivals
    assert late.best in late.rivals


def test_noise_alone_rarely_gains_the_threshold(late: Found) -> None:
    assert np.mean(late.nulls > late.threshold) <= 0.011


def test_the_same_seed_finds_the_same(late: Found) -> None:
    again = _found(threshold(25.0))
    np.testing.assert_array_equal(again.nulls, late.nulls)
    np.testing.assert_array_equal(
        again.best.fit.point.shifts, late.best.fit.point.shifts
    )
    assert again.best.fit.point.effects == late.best.fit.point.effects
    assert again.gains == late.gains


def test_another_seed_draws_other_recordings(late: Found) -> None:
    other = _found(threshold(25.0), seed=1)
    assert not np.array_equal(other.nulls, late.nulls)
    assert other.best.names == late.best.names


def test_the_evidence_of_an_amplitude_is_its_marginal_likelihood() -> None:
    problem = problem_of(recording(lambda m: 4.0 + 0 * m.time), MODEL, {})
    problem = replace(problem, constants=(INERT,))
    start = Point(np.zeros(1))
    bias = Candidate("force_sensor_bias", ForceSensorBias(bias=5.0))
    null = Rival((), polished(problem, start))
    rival = Rival((bias,), polished(problem, added(start, bias)))
    unit = rival.fit.coordinates[0].unit
    law = problem.noises[Signal.FORCE]
    square, moment = 0.0, 0.0
    for block, time, left in zip(
        problem.blocks, problem.times, problem.residuals(start), strict=True
    ):
        if block.signal is Signal.FORCE:
            column = np.full(time.size, unit)
            seen = np.linalg.solve(covariance(time, law), column)
            square += float(seen @ column)
            moment += float(seen @ left)
    # log N(y; 0, C + uu') - log N(y; 0, C), by the matrix determinant lemma.
    gain = 0.5 * moment**2 / (1 + square) - 0.5 * np.log1p(square)
    assert rival.evidence - null.evidence == pytest.approx(gain, rel=0.01)


def test_the_excess_of_a_right_explanation_is_little(late: Found) -> None:
    # Chi² of n samples scatters by the root of 2 n.
    assert abs(late.best.excess) < 6 * (2 * late.best.fit.samples) ** 0.5
    assert late.null.excess > late.best.excess + 100


def test_a_candidate_is_put_in_as_what_it_is(blank: Problem) -> None:
    start = Point(np.zeros(len(blank.constants)))
    rub = CoulombFriction(magnitude=20.0)
    assert added(start, Candidate("coulomb_friction", rub)).effects == (rub,)
    assert added(start, Candidate("parameter:x", None, 3)).freed == {3}


@pytest.mark.parametrize(
    ("candidate", "signals"),
    [
        (Candidate("c", CoulombFriction()), {Signal.FORCE}),
        (Candidate("v", ValveOffset()), {Signal.PRESSURE}),
        (Candidate("s", PressureSensorBias()), {Signal.FORCE, Signal.PRESSURE}),
        (Candidate("parameter:muscle.rest_length", None, 0), {Signal.FORCE}),
    ],
)
def test_a_candidate_acts_on_these_of_the_signals_explained(
    blank: Problem, candidate: Candidate, signals: set[Signal]
) -> None:
    assert blank.constants[0].path == "muscle.rest_length"
    assert acts_on(blank, candidate) == signals
