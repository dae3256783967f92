from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.fit.candidates import UNUSUAL, Candidate
from gripperd.diagnose.fit.polish import polished
from gripperd.diagnose.fit.rival import Rival, added, fitted
from gripperd.diagnose.residuals.constants import Constant
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.found import Found
from gripperd.diagnose.setup import problem_of
from gripperd.effects.coulomb_friction import CoulombFriction
from gripperd.effects.creep import Creep, Holding
from gripperd.effects.force_sensor_bias import ForceSensorBias
from gripperd.model.effect import Signal
from gripperd.model.track import Array
from tests.diagnose.searched import searched
from tests.diagnose.small import (
    MODEL,
    Moment,
    covariance,
    recording,
    rubbing,
    threshold,
    undoubted,
)

INERT = Constant("gripper.open_width", 0.085, 1e-3, stated=False)
"""Of a part that this rig has not: it changes nothing."""


@pytest.fixture(scope="module")
def late() -> Found:
    return searched(threshold(25.0))


def test_the_evidence_of_an_amplitude_is_its_marginal_likelihood() -> None:
    problem = problem_of(recording(lambda m: 4.0 + 0 * m.time), MODEL, {})
    problem = undoubted(replace(problem, constants=(INERT,)))
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


def test_where_the_model_means_what_it_seldom_does_more_must_be_explained(
    late: Found,
) -> None:
    fit = late.null.fit
    settled, at_once = (
        Rival((), replace(fit, point=fit.point.with_effect(Creep(holds=holds))))
        for holds in (Holding.SETTLED, Holding.AT_ONCE)
    )
    assert settled.evidence == late.null.evidence
    assert settled.evidence - at_once.evidence == pytest.approx(UNUSUAL)


def test_the_excess_of_a_right_explanation_is_little(late: Found) -> None:
    # Chi² of n samples scatters by the root of 2 n.
    assert abs(late.best.excess) < 6 * (2 * late.best.fit.samples) ** 0.5
    assert late.null.excess > late.best.excess + 100


@pytest.mark.parametrize("rubs_at_rest", [True, False])
def test_a_friction_that_need_not_slip_is_there_at_rest_as_well(
    *, rubs_at_rest: bool
) -> None:
    def hidden(moment: Moment) -> Array:
        moves = np.ptp(moment.contraction) > 0
        return rubbing(25.0)(moment) * (moves or rubs_at_rest)

    problem = problem_of(recording(hidden), MODEL, {})
    # The least there is: travel calls up all of it, and rest nothing.
    slips = Candidate("coulomb_friction", CoulombFriction(magnitude=20.0, slip=1e-4))
    bias = Candidate("force_sensor_bias", ForceSensorBias(bias=5.0))
    start = Point(np.zeros(len(problem.constants)))
    (rival,) = fitted(problem, [((slips, bias), added(added(start, slips), bias))])
    # They act in the order they had.
    effect, last = rival.fit.point.effects
    assert isinstance(last, ForceSensorBias)
    assert isinstance(effect, CoulombFriction)
    assert (effect.slip == 0) == rubs_at_rest
    assert effect.magnitude == pytest.approx(25.0, abs=1.5)


def test_a_candidate_is_put_in_as_what_it_is(blank: Problem) -> None:
    start = Point(np.zeros(len(blank.constants)))
    rub = CoulombFriction(magnitude=20.0)
    assert added(start, Candidate("coulomb_friction", rub)).effects == (rub,)
    assert added(start, Candidate("parameter:x", None, 3)).freed == {3}
