from dataclasses import replace

import pytest

from gripperd.diagnose.diagnosis import Diagnosis, diagnose
from gripperd.diagnose.fit.rival import Rival
from gripperd.diagnose.search.rivalry import Contest, Place
from gripperd.diagnose.verdict.conclude import (
    Conclusion,
    Verdict,
    conclude,
    not_confirmed,
)
from gripperd.effects.threshold_pressure import ThresholdPressure
from gripperd.model.effect import Signal
from tests.diagnose.small import MODEL, Hidden, nothing, recording, restless


def _judged(told: Diagnosis, contest: Contest) -> Conclusion:
    return conclude(told.split.train, told.found, contest)


def _won(told: Diagnosis, best: Rival, *rivals: Rival) -> Contest:
    return Contest(best, (Place(told.found.null, rivals),))


def test_what_explains_all_and_has_no_rival_is_named(told: Diagnosis) -> None:
    concluded = _judged(told, _won(told, told.contest.best))
    assert concluded.verdict is Verdict.NAMED
    assert concluded.share > 0.9


def test_with_an_equal_rival_it_is_ambiguous(told: Diagnosis) -> None:
    twin = told.contest.best
    concluded = _judged(told, _won(told, twin, twin))
    assert concluded.verdict is Verdict.AMBIGUOUS


def test_structure_that_nothing_explains_is_unexplained(told: Diagnosis) -> None:
    concluded = _judged(told, Contest(told.found.null))
    assert concluded.verdict is Verdict.UNEXPLAINED
    assert concluded.share == pytest.approx(0.0, abs=0.05)


def test_noise_alone_is_none() -> None:
    told = diagnose(recording(nothing), MODEL, {}, {})
    assert told.verdict is Verdict.NONE


@pytest.mark.parametrize(
    ("kilopascals", "verdict"),
    [(8.0, Verdict.UNEXPLAINED), (16.0, Verdict.UNEXPLAINED), (18.0, Verdict.NAMED)],
)
def test_a_name_is_kept_from_most_of_the_structure(
    told: Diagnosis, kilopascals: float, verdict: Verdict
) -> None:
    # The rig hides 25 kPa: 16 takes 65 % of the structure, 18 takes 78 %.
    weak = ThresholdPressure(pressure=1e3 * kilopascals)
    best = told.contest.best
    point = best.fit.point.with_effect(weak)
    poor = replace(best, fit=replace(best.fit, point=point))
    concluded = _judged(told, _won(told, poor))
    assert concluded.verdict is verdict
    assert concluded.signals == (Signal.FORCE,)


@pytest.mark.parametrize(
    ("hidden", "verdict"),
    [(nothing, Verdict.NONE), (restless(nothing), Verdict.UNEXPLAINED)],
)
def test_a_name_that_is_not_borne_out_leaves_what_there_was_without_it(
    hidden: Hidden, verdict: Verdict
) -> None:
    bare = diagnose(recording(hidden), MODEL, {}, {})
    without = conclude(bare.split.train, bare.found, bare.contest)
    named = replace(without, verdict=Verdict.NAMED)
    assert not_confirmed(named, is_open=False).verdict is verdict
    assert not_confirmed(named, is_open=True).verdict is Verdict.UNEXPLAINED
