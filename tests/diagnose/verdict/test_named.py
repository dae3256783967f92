from dataclasses import replace
from math import pi, radians, sin, tan

import numpy as np
import pytest

from gripperd.diagnose.diagnosis import Diagnosis, diagnose
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.search.rivalry import Contest
from gripperd.diagnose.verdict.gap import by_signal
from gripperd.diagnose.verdict.initial_state import with_fitted_state
from gripperd.diagnose.verdict.named import Named, named
from gripperd.effects.threshold_pressure import ThresholdPressure
from gripperd.model.effect import Signal
from tests.diagnose.small import MODEL, recording
from tests.diagnose.small import threshold as hidden


@pytest.fixture
def threshold(told: Diagnosis) -> Named:
    (entry,) = told.named
    return entry


@pytest.fixture(scope="module")
def fat() -> Named:
    """What is found with a model whose muscle is a tenth too wide."""
    model = replace(MODEL, muscle=replace(MODEL.muscle, diameter=0.022))
    (entry,) = diagnose(recording(), model, {"muscle.diameter": 5e-5}, {}).named
    return entry


def test_an_effect_is_described_with_its_numbers(threshold: Named) -> None:
    assert (threshold.name, threshold.stage) == ("threshold_pressure", "muscle")
    assert set(threshold.parameters) == {"pressure", "softness"}
    assert threshold.path is None


def test_the_interval_holds_the_truth(threshold: Named) -> None:
    pressure = threshold.parameters["pressure"]
    assert 0 < pressure.std < 2e3
    assert abs(pressure.value - 25e3) < 4 * pressure.std


def test_its_numbers_are_those_of_the_effect(threshold: Named) -> None:
    assert threshold.effect is not None
    for name, estimate in threshold.parameters.items():
        assert getattr(threshold.effect, name) == estimate.value


def test_its_size_is_what_it_changes(told: Diagnosis, threshold: Named) -> None:
    assert threshold.signal is Signal.FORCE
    problem = told.split.train
    lost = []
    for block in problem.blocks:
        if block.signal is Signal.FORCE:
            course = problem.courses[block.course]
            h, p = course.column("contraction"), course.column("pressure")
            area = (
                pi
                * 1e-4
                * (3 * (1 - h) ** 2 / tan(radians(25)) ** 2 - 1 / sin(radians(25)) ** 2)
            )
            lost.append((np.clip(p, 0.0, 25e3) * area)[block.good])
    expected = float(np.sqrt(np.mean(np.concatenate(lost) ** 2)))
    assert threshold.size == pytest.approx(expected, rel=0.1)


def test_such_a_gain_on_noise_alone_is_beyond_chance(threshold: Named) -> None:
    assert 0.0 <= threshold.p_value < 1e-6


def _chance(told: Diagnosis, least: float, most: float) -> float:
    """Chance when noise gains from least to most above what was gained. [nat]"""
    gain = told.contest.best.evidence - told.contest.places[0].without.evidence
    nulls = np.linspace(gain + least, gain + most, 400)
    (entry,) = named(replace(told.found, nulls=nulls), told.contest, [told.gaps])
    return entry.p_value


def test_the_chance_is_the_share_of_noise_that_gains_as_much(told: Diagnosis) -> None:
    assert _chance(told, -1.0, 1.0) == pytest.approx(0.5, abs=0.01)
    assert _chance(told, -1.0, 3.0) == pytest.approx(0.75, abs=0.01)


def test_beyond_what_was_drawn_it_falls_with_the_odds(told: Diagnosis) -> None:
    assert _chance(told, -20.0, -2.0) == pytest.approx(np.exp(-2.0) / 401)


def test_it_is_worth_its_numbers_by_bic(told: Diagnosis, threshold: Named) -> None:
    without = told.contest.places[0].without.fit
    fall = without.cost - told.contest.best.fit.cost
    assert threshold.delta_bic < -50.0
    # Two numbers, each at the logarithm of the effective samples: 5 to 8.
    assert 2 * 5.0 < threshold.delta_bic + fall < 2 * 8.0


def test_it_closes_the_gap_on_what_was_left_out(
    told: Diagnosis, threshold: Named
) -> None:
    closed = told.gaps[Signal.FORCE].closed
    assert threshold.heldout_gain == pytest.approx(closed, rel=1e-4)
    assert threshold.heldout_gain > 0.5


def test_of_two_each_is_told_what_it_closes_beside_the_other() -> None:
    model = replace(MODEL, muscle=replace(MODEL.muscle, diameter=0.0215))
    library = {"threshold_pressure": ThresholdPressure}
    told = diagnose(recording(hidden(25.0)), model, {"muscle.diameter": 5e-5}, library)
    assert {one.name for one in told.named} == {*library, "parameter:muscle.diameter"}
    gap = told.gaps[Signal.FORCE]

    def excess(point: Point) -> float:
        """Mean square of the force above the noise. [N²]."""
        fitted = with_fitted_state(told.split, point)
        force = by_signal(told.split.test, fitted)[Signal.FORCE]
        return float(np.mean(force**2)) - gap.noise_floor**2

    left = excess(told.explained)
    for entry, place in zip(told.named, told.contest.places, strict=True):
        closed = 1 - left / excess(place.without.fit.point)
        assert entry.heldout_gain == pytest.approx(closed, rel=1e-4)
    assert told.named[0].heldout_gain != pytest.approx(told.named[1].heldout_gain)


def test_a_wrong_constant_is_named_by_its_path(fat: Named) -> None:
    assert fat.name == "parameter:muscle.diameter"
    assert (fat.path, fat.effect, fat.stage) == ("muscle.diameter", None, "-")


def test_its_value_is_that_of_the_rig(fat: Named) -> None:
    ((name, diameter),) = fat.parameters.items()
    assert name == "diameter"
    assert diameter.std < 3e-4
    assert abs(diameter.value - 0.020) < 4 * diameter.std


def test_a_number_knows_beyond_what_nothing_was_sought(
    threshold: Named, fat: Named
) -> None:
    pressure, (diameter,) = threshold.parameters["pressure"], fat.parameters.values()
    assert 0.0 <= pressure.low < 25e3 < pressure.high < np.inf
    # Let go, it may be off by far more than two tolerances of 0.05 mm, but not by all.
    assert 0.018 < diameter.low <= diameter.value < 0.0219 < diameter.high < 0.026


def test_nothing_found_is_nothing_named(told: Diagnosis) -> None:
    assert named(told.found, Contest(told.found.null), []) == ()
