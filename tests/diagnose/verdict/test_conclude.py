from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.diagnosis import Diagnosis, diagnose
from gripperd.diagnose.fit.rival import Rival
from gripperd.diagnose.noise.model import Noise
from gripperd.diagnose.search.rivalry import Contest, Place
from gripperd.diagnose.verdict.conclude import (
    Conclusion,
    Verdict,
    conclude,
    not_confirmed,
)
from gripperd.diagnose.verdict.conclude import _remaining as remaining
from gripperd.diagnose.verdict.signature import signature
from gripperd.diagnose.verdict.structure import Structure
from gripperd.effects.threshold_pressure import ThresholdPressure
from gripperd.model.effect import Signal
from gripperd.model.track import Array
from tests.diagnose.small import (
    FORCE_NOISE,
    MODEL,
    Hidden,
    Moment,
    altered,
    moments,
    nothing,
    recording,
    restless,
)


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
    ("times", "verdict"), [(0.8, Verdict.NONE), (2.0, Verdict.UNEXPLAINED)]
)
def test_what_is_too_loud_for_noise_is_unexplained_whatever_it_looks_like(
    times: float, verdict: Verdict
) -> None:
    def hurried(force: Array) -> Array:
        """As much louder, but in nothing slow."""
        white = np.random.default_rng(force.size).normal(0.0, 1.0, force.size + 1)
        return force + times * FORCE_NOISE * np.diff(white) / 2**0.5

    loud = altered(recording(), [*moments()], "force", hurried)
    told = diagnose(loud, MODEL, {}, {})
    noises = {**told.split.train.noises, Signal.FORCE: Noise(FORCE_NOISE, 0.0)}
    problem = replace(told.split.train, noises=noises)
    concluded = conclude(problem, told.found, Contest(told.found.null))
    assert concluded.verdict is verdict
    expected = (1 + times**2) ** 0.5
    if verdict is Verdict.UNEXPLAINED:
        assert concluded.louder[Signal.FORCE] == pytest.approx(expected, rel=0.05)
        assert concluded.signals == (Signal.FORCE,)
        told_of = signature(problem, Contest(told.found.null), concluded)
        assert "force: 2.2 times as loud as its noise" in told_of


def test_what_is_too_loud_but_small_is_no_more_than_sensors_do() -> None:
    def rippled(moment: Moment) -> Array:
        """A newton of a pull of 1272 N, ten times as loud as this cell's noise."""
        return np.sin(3 * np.pi * moment.pressure / 500e3 + 20 * moment.contraction)

    assert (
        diagnose(recording(rippled, noise=0.1), MODEL, {}, {}).verdict is Verdict.NONE
    )


@pytest.mark.parametrize(("samples", "loud"), [(72, False), (400, True)])
def test_few_samples_must_be_louder(samples: int, *, loud: bool) -> None:
    # Three standard errors of a mean square: 3.0 of 72 samples, 2.42 of 400.
    told = diagnose(recording(nothing), MODEL, {}, {})
    fit = told.found.null.fit
    counted = replace(fit, counts={**fit.counts, Signal.FORCE: samples})
    known = told.split.train.noises
    quiet = replace(
        known[Signal.FORCE], std=known[Signal.FORCE].std / 2.7**0.5, drift=0.0
    )
    problem = replace(told.split.train, noises={**known, Signal.FORCE: quiet})
    null = replace(told.found.null, fit=counted)
    louder = conclude(problem, told.found, Contest(null)).louder
    assert (Signal.FORCE in louder) is loud


def test_a_name_withdrawn_from_what_is_loud_leaves_it_unexplained() -> None:
    loud = Conclusion(Verdict.NAMED, (), 1.0, (), {Signal.FORCE: 2.0})
    assert not_confirmed(loud, is_open=False).verdict is Verdict.UNEXPLAINED
    calm = Conclusion(Verdict.NAMED, (), 1.0)
    assert not_confirmed(calm, is_open=False).verdict is Verdict.NONE


@pytest.mark.parametrize(
    ("kilopascals", "verdict"),
    [(8.0, Verdict.UNEXPLAINED), (18.0, Verdict.UNEXPLAINED), (20.0, Verdict.NAMED)],
)
def test_a_name_is_kept_from_most_of_the_structure(
    told: Diagnosis, kilopascals: float, verdict: Verdict
) -> None:
    # The rig hides 25 kPa: 18 takes 78 % of the structure, 20 takes 88 %.
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


@pytest.mark.parametrize(
    ("newtons", "verdict"), [(0.0, Verdict.NONE), (60.0, Verdict.UNEXPLAINED)]
)
def test_what_happens_in_a_sweep_that_took_no_part_alone_is_unexplained(
    newtons: float, verdict: Verdict
) -> None:
    plain = recording(nothing)
    left_out = diagnose(plain, MODEL, {}, {}).held_out

    def struck(force: Array) -> Array:
        """A bump of some seconds, as somebody leans on the bench."""
        since = np.linspace(-1.0, 1.0, force.size)
        return force + newtons * np.exp(-((since / 0.3) ** 2))

    told = diagnose(altered(plain, left_out, "force", struck), MODEL, {}, {})
    assert told.held_out == left_out
    assert told.verdict is verdict
    if verdict is Verdict.UNEXPLAINED:
        assert told.main is Signal.FORCE
        times = told.gaps[Signal.FORCE].left_open
        assert f"force: {times:.1f} times its noise in what took no part" in (
            told.signature
        )


@pytest.mark.parametrize(
    ("wanders", "size", "remains"),
    [
        (0.003, 0.0025, False),
        (0.003, 0.0035, True),
        (0.001, 0.0025, True),
        (0.001, 0.0012, False),
        (0.0, 0.001, False),
    ],
)
def test_structure_must_be_larger_than_what_sensors_wander(
    wanders: float, size: float, *, remains: bool
) -> None:
    left = Structure(Signal.FORCE, "pressure", 300.0, 1e-30, size, 0.1, wanders)
    assert bool(remaining([left])) is remains
