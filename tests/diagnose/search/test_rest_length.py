from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
import pytest

from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.rest_length import length_is_open, with_other_length
from gripperd.diagnose.search.rivalry import Contest, Place
from gripperd.diagnose.setup import problem_of
from gripperd.effects.coulomb_friction import CoulombFriction
from gripperd.effects.force_sensor_bias import ForceSensorBias
from gripperd.effects.threshold_pressure import ThresholdPressure
from gripperd.model.track import Array
from tests.diagnose.fitted import fitted
from tests.diagnose.small import (
    MODEL,
    Moment,
    pinned,
    recording,
    textbook,
    threshold,
)

BUILT, TOLD = 0.245, MODEL.muscle.rest_length
TOLERANCES = {"muscle.rest_length": 0.004}
LATE = Candidate("threshold_pressure", ThresholdPressure(pressure=20e3))
RUB = Candidate("coulomb_friction", CoulombFriction(magnitude=20.0))
BIAS = Candidate("force_sensor_bias", ForceSensorBias(bias=5.0))


@dataclass(frozen=True, slots=True)
class Twin(ThresholdPressure):
    """The same formula by another name."""

    name: ClassVar[str] = "twin"


TWIN = Candidate("twin", Twin(pressure=20e3))


def _counted_from_another_length(moment: Moment) -> Array:
    """A threshold in a muscle 5 mm shorter than the recorder takes it to be."""
    own = replace(moment, contraction=1 - (1 - moment.contraction) * TOLD / BUILT)
    return np.asarray(textbook(own) + threshold(15.0)(own) - textbook(moment))


@pytest.fixture(scope="module")
def train() -> Problem:
    problem = problem_of(recording(_counted_from_another_length), MODEL, TOLERANCES)
    return pinned(problem, "muscle.rest_length")


def _won(problem: Problem, *candidates: Candidate) -> Contest:
    """A contest that ended with these, and without any rival."""
    bare = Place(fitted(problem))
    return Contest(fitted(problem, *candidates), (bare,) * len(candidates))


def _opened(problem: Problem, *best: Candidate) -> Contest:
    listed, rng = (LATE, TWIN, RUB, BIAS), np.random.default_rng(0)
    return with_other_length(problem, _won(problem, *best), listed, rng)


def test_who_leads_with_the_zero_open_could_stand_for_what_was_named(
    train: Problem,
) -> None:
    opened = _opened(train, BIAS)
    assert opened.best.names == ("force_sensor_bias",)
    (others,) = opened.equivalents
    # Friction explains far less, so it is no rival with any zero.
    assert set(others) == {"threshold_pressure", "twin"}
    for rival in opened.places[0].rivals:
        length = TOLD + TOLERANCES["muscle.rest_length"] * rival.fit.point.shifts[0]
        assert length == pytest.approx(BUILT, abs=3e-4)


def test_it_stands_for_the_first_effect_alone(train: Problem) -> None:
    opened = _opened(train, BIAS, RUB)
    first, second = opened.places
    assert {one.names for one in first.rivals} == {
        ("threshold_pressure", "coulomb_friction"),
        ("twin", "coulomb_friction"),
    }
    assert second.rivals == ()


def test_what_is_named_already_is_no_rival_of_itself(train: Problem) -> None:
    assert _opened(train, LATE).equivalents == (("twin",),)
    assert _opened(train, BIAS, LATE).equivalents == (("twin",), ())


@pytest.mark.parametrize(
    ("sigma", "is_open"), [(0.0, False), (0.003, False), (0.004, True)]
)
def test_the_zero_is_open_when_the_length_is_known_to_worse_than_an_eightieth(
    train: Problem, sigma: float, *, is_open: bool
) -> None:
    # 250 mm / 80 = 3.1 mm.
    best = _won(train, BIAS)
    assert length_is_open(train, best, {"muscle.rest_length": sigma}) is is_open


def test_the_zero_of_a_recorded_length_is_told(train: Problem) -> None:
    told = replace(train, model=replace(train.model, told_length=TOLD))
    assert not length_is_open(told, _won(train, BIAS), TOLERANCES)


def test_where_nothing_is_named_the_zero_may_stay_open(train: Problem) -> None:
    assert not length_is_open(train, _won(train), TOLERANCES)
