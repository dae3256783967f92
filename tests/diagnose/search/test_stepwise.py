from math import radians

import numpy as np
import pytest

from gripperd.diagnose.fit.candidates import Candidate, forms
from gripperd.diagnose.fit.polish import polished
from gripperd.diagnose.readings.recording import Recording
from gripperd.diagnose.search.found import Found
from gripperd.diagnose.search.stepwise import search
from gripperd.diagnose.setup import problem_of
from gripperd.effects.force_sensor_gain import ForceSensorGain
from gripperd.effects.threshold_pressure import ThresholdPressure
from gripperd.model.track import Array
from tests.diagnose.fitted import fitted
from tests.diagnose.searched import OPEN, searched
from tests.diagnose.small import (
    MODEL,
    Hidden,
    Moment,
    altered,
    moments,
    nothing,
    pinned,
    recording,
    rubbing,
    tabled,
    threshold,
)

KNOWN = {
    "muscle.diameter": 1e-4,
    "muscle.braid_angle": radians(0.15),
    "muscle.rest_length": 1e-4,
}
"""Tolerances that leave a factor of the force to nothing else."""
GAIN = Candidate("force_sensor_gain", ForceSensorGain(error=0.02))
THRESHOLD = Candidate("threshold_pressure", ThresholdPressure(pressure=20e3))


def _both(moment: Moment) -> Array:
    return threshold(30.0)(moment) + rubbing(25.0)(moment)


@pytest.fixture(scope="module")
def late() -> Found:
    return searched(threshold(25.0))


def test_where_nothing_is_hidden_nothing_issearched() -> None:
    found = searched(nothing)
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
def test_what_is_hidden_issearched(hidden: Hidden, names: set[str]) -> None:
    assert set(searched(hidden).best.names) == names


@pytest.mark.parametrize(
    ("kilopascals", "names"), [(2.0, ()), (2.5, ("threshold_pressure",))]
)
def test_a_first_effect_is_believed_at_odds_of_a_million(
    kilopascals: float, names: tuple[str, ...]
) -> None:
    found = searched(threshold(kilopascals))
    assert found.best.names == names
    gain = found.best.evidence - found.null.evidence
    assert not names or 13.8 < gain < 20.0


def test_what_a_drift_could_imitate_must_gain_more(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    needs = ThresholdPressure.needs | {"temperature"}
    monkeypatch.setattr(ThresholdPressure, "needs", needs)
    assert searched(threshold(2.5)).best.names == ()
    assert searched(threshold(3.0)).best.names == ("threshold_pressure",)


def test_far_from_the_model_and_without_a_candidate_nothing_is_named() -> None:
    problem = pinned(problem_of(recording(threshold(60.0)), MODEL, {}), *OPEN)
    found = search(problem, (), np.random.default_rng(0))
    assert found.problem.is_inflated
    assert found.best is found.null


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
    again = searched(threshold(25.0))
    np.testing.assert_array_equal(again.nulls, late.nulls)
    np.testing.assert_array_equal(
        again.best.fit.point.shifts, late.best.fit.point.shifts
    )
    assert again.best.fit.point.effects == late.best.fit.point.effects
    assert again.gains == late.gains


def test_another_seed_draws_other_recordings(late: Found) -> None:
    other = searched(threshold(25.0), seed=1)
    assert not np.array_equal(other.nulls, late.nulls)
    assert other.best.names == late.best.names


@pytest.mark.parametrize(
    ("told", "share"),
    [(tabled(threshold(25.0)), 3), (recording(threshold(25.0)), 1)],
    ids=["table", "sweeps"],
)
def test_of_a_table_every_form_is_fitted_in_full_of_sweeps_the_likeliest(
    told: Recording, share: int
) -> None:
    problem = pinned(problem_of(told, MODEL, {}), *OPEN)
    listed = [Candidate(one.name, one) for one in forms(ThresholdPressure)]
    found = search(problem, listed, np.random.default_rng(0))
    heard = [one for rival in found.rivals for one in rival.candidates]
    assert len(listed) == 3
    assert len(heard) == len(set(heard)) == share
    assert set(heard) <= set(listed)
    fits = [fitted(found.problem, one).evidence for one in listed]
    # A search fits again when it knows how loud the rest is, and may come further.
    assert found.best.evidence >= max(fits) - 0.5
    again = polished(found.problem, found.best.fit.point)
    assert found.best.fit.cost == pytest.approx(again.cost, abs=0.5)


@pytest.mark.parametrize(
    ("factor", "hidden", "candidate", "told"),
    [
        pytest.param(1.055, nothing, GAIN, True, id="a factor"),
        pytest.param(1.0, threshold(3.2), THRESHOLD, False, id="a form of ours"),
    ],
)
def test_at_odds_of_a_few_thousand_only_what_little_resembles_is_named(
    factor: float, hidden: Hidden, candidate: Candidate, *, told: bool
) -> None:
    off = altered(recording(hidden), moments(), "force", lambda force: factor * force)
    found = search(problem_of(off, MODEL, KNOWN), [candidate], np.random.default_rng(0))
    assert 8.0 < found.gains[candidate.name] < 20.0
    assert found.best.names == ((candidate.name,) if told else ())
