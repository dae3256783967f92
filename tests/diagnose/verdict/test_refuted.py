from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.diagnosis import Diagnosis
from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.fit.polish import polished
from gripperd.diagnose.fit.rival import Rival
from gripperd.diagnose.residuals.holdout import split
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.needed import without_each
from gripperd.diagnose.search.rivalry import Contest, Place
from gripperd.diagnose.verdict.refuted import refuted, without_refuted
from gripperd.effects.coulomb_friction import CoulombFriction
from gripperd.effects.threshold_pressure import ThresholdPressure
from gripperd.model.effect import Signal


@pytest.fixture
def blank_told(blank: Problem, told: Diagnosis) -> Contest:
    """A threshold that is told of sweeps in which nothing is hidden."""
    null = polished(split(blank).train, Point(np.zeros(len(blank.constants))))
    (place,) = told.contest.places
    without = replace(place.without, fit=null)
    point = replace(null.point, effects=(ThresholdPressure(pressure=25e3),))
    best = replace(told.contest.best, fit=replace(null, point=point))
    return Contest(best, (Place(without),))


def test_sweeps_in_which_it_acts_do_not_speak_against_a_name(told: Diagnosis) -> None:
    parts = told.split
    assert refuted(parts, parts.test, told.found, told.contest) == ()


def test_sweeps_in_which_it_does_not_act_do(
    blank: Problem, told: Diagnosis, blank_told: Contest
) -> None:
    parts = split(blank)
    names = refuted(parts, parts.test, told.found, blank_told)
    assert names == ("threshold_pressure",)


def test_what_it_hardly_changes_says_nothing(
    blank: Problem, told: Diagnosis, blank_told: Contest
) -> None:
    best = blank_told.best
    faint = replace(best.fit.point, effects=(ThresholdPressure(pressure=0.3e3),))
    contest = Contest(
        replace(best, fit=replace(best.fit, point=faint)), blank_told.places
    )
    parts = split(blank)
    assert refuted(parts, parts.test, told.found, contest) == ()


def test_misfit_that_nothing_reaches_is_noise_to_it(
    blank: Problem, told: Diagnosis, blank_told: Contest
) -> None:
    problem = told.found.problem
    loud = {
        signal: replace(noise, std=100 * noise.std, drift=100 * noise.drift)
        for signal, noise in problem.noises.items()
    }
    inflated = replace(told.found, problem=replace(problem, noises=loud))
    parts = split(blank)
    assert refuted(parts, parts.test, inflated, blank_told) == ()


def _with_friction(told: Diagnosis) -> Contest:
    """The threshold that is hidden, and beside it a friction that is not."""
    right = told.contest.best
    rubs = Candidate("coulomb_friction", CoulombFriction(magnitude=40.0))
    point = right.fit.point.with_effect(CoulombFriction(magnitude=40.0))
    both = Rival((*right.candidates, rubs), replace(right.fit, point=point))
    places = tuple(map(Place, without_each(told.found.problem, both)))
    return Contest(both, places)


def test_what_stands_beside_a_wrong_name_stays_told(told: Diagnosis) -> None:
    parts, wrong = told.split, _with_friction(told)
    assert "coulomb_friction" in refuted(parts, parts.test, told.found, wrong)
    listed = wrong.best.candidates
    rest = without_refuted(parts, parts.test, told.found, wrong, listed)
    assert rest.best.names == ("threshold_pressure",)
    threshold = rest.best.fit.point.effects[-1]
    assert isinstance(threshold, ThresholdPressure)
    assert threshold.pressure == pytest.approx(25e3, rel=0.1)


@pytest.mark.parametrize(("gain", "stays"), [(14.0, True), (12.0, False)])
def test_what_is_left_must_gain_what_it_needs_alone(
    told: Diagnosis, gain: float, *, stays: bool
) -> None:
    parts, wrong, null = told.split, _with_friction(told), told.found.null
    (_, place) = wrong.places
    assert place.without.names == ("threshold_pressure",)
    more = place.without.evidence - null.evidence - gain
    null = replace(null, fit=replace(null.fit, cost=null.fit.cost - 2 * more))
    found = replace(told.found, null=null)
    rest = without_refuted(parts, parts.test, found, wrong, wrong.best.candidates)
    assert rest.best.names == (("threshold_pressure",) if stays else ())


def test_a_name_alone_is_not_taken_away(
    blank: Problem, told: Diagnosis, blank_told: Contest
) -> None:
    parts = split(blank)
    found = replace(told.found, best=blank_told.best)
    rest = without_refuted(parts, parts.test, found, blank_told, ())
    assert rest is blank_told


@pytest.mark.parametrize("inflated", [1.0, 2.0])
def test_far_above_the_noise_no_constant_is_refuted(
    blank: Problem, told: Diagnosis, blank_told: Contest, inflated: float
) -> None:
    best = blank_told.best
    bore = replace(best, candidates=(Candidate("parameter:muscle.diameter", None, 0),))
    found = replace(
        told.found,
        problem=replace(told.found.problem, inflations={Signal.FORCE: inflated}),
    )
    parts = split(blank)
    names = refuted(parts, parts.test, found, replace(blank_told, best=bore))
    assert bool(names) is (inflated == 1.0)


def _only_friction(told: Diagnosis, *alike: Rival) -> Contest:
    """A friction of 40 N that is told, which is not hidden, and what fits as well."""
    bare = told.contest.places[0].without
    point = bare.fit.point.with_effect(CoulombFriction(magnitude=40.0))
    rubs = Candidate("coulomb_friction", CoulombFriction(magnitude=40.0))
    wrong = Rival((rubs,), replace(bare.fit, point=point))
    return Contest(wrong, (Place(bare, alike),))


def test_of_two_that_fit_as_well_the_one_that_is_borne_out_is_told(
    told: Diagnosis,
) -> None:
    parts, right = told.split, told.contest.best
    wrong = _only_friction(told, right)
    found = without_refuted(parts, parts.test, told.found, wrong, ())
    assert found.best is right
    assert found.equivalents == ((),)


def test_where_both_are_refuted_neither_takes_the_place_of_the_other(
    told: Diagnosis,
) -> None:
    parts, wrong = told.split, _only_friction(told)
    both = _only_friction(told, wrong.best)
    found = without_refuted(parts, parts.test, told.found, both, ())
    assert found is both
