import numpy as np
import pytest

from gripperd.diagnose.candidates import Candidate
from gripperd.diagnose.found import Found
from gripperd.diagnose.search import search
from gripperd.diagnose.setup import problem_of
from gripperd.effects.coulomb_friction import CoulombFriction
from gripperd.effects.force_sensor_bias import ForceSensorBias
from gripperd.effects.threshold_pressure import ThresholdPressure
from gripperd.model.track import Array
from tests.diagnose.small import (
    MODEL,
    Hidden,
    Moment,
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
