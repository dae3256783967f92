"""Which explanation is believed, of rivals whose evidence is given."""

from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.fit.candidates import WRONG, Candidate
from gripperd.diagnose.fit.polish import polished
from gripperd.diagnose.fit.rival import Rival, added
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.belief import (
    LEAST,
    LEAST_PLAIN,
    LEAST_SLOW,
    LEAST_WRONG,
    least,
    simplest,
)
from gripperd.diagnose.setup import problem_of
from gripperd.effects.channel_delay import ChannelDelay
from gripperd.effects.coulomb_friction import CoulombFriction
from gripperd.effects.fatigue import Fatigue
from gripperd.effects.first_cycle import FirstCycle
from gripperd.effects.force_sensor_drift import ForceSensorDrift
from gripperd.effects.force_sensor_gain import ForceSensorGain
from gripperd.effects.leak import Leak
from gripperd.effects.temperature_stiffness import TemperatureStiffness
from gripperd.effects.threshold_pressure import ThresholdPressure
from gripperd.model.effect import Effect
from tests.diagnose.small import MODEL, recording

CHANCE = 1.0
GAIN = Candidate("force_sensor_gain", ForceSensorGain(error=0.03))
THRESHOLD = Candidate("threshold_pressure", ThresholdPressure(pressure=25e3))
FRICTION = Candidate("coulomb_friction", CoulombFriction(magnitude=20.0))


@pytest.fixture(scope="module")
def problem() -> Problem:
    return problem_of(recording(), MODEL, {})


@pytest.fixture(scope="module")
def null(problem: Problem) -> Rival:
    return Rival((), polished(problem, Point(np.zeros(len(problem.constants)))))


@pytest.fixture(scope="module")
def bore(problem: Problem) -> Candidate:
    paths = [one.path for one in problem.constants]
    return Candidate(f"{WRONG}muscle.diameter", None, paths.index("muscle.diameter"))


def _with(null: Rival, gain: float, *candidates: Candidate) -> Rival:
    """The null and some candidates, which gain so much evidence."""
    point = null.fit.point
    for one in candidates:
        point = added(point, one)
    bare = Rival(candidates, replace(null.fit, point=point))
    lacking = gain - (bare.evidence - null.evidence)
    return replace(bare, fit=replace(bare.fit, cost=bare.fit.cost - 2 * lacking))


def _names(problem: Problem, null: Rival, *rivals: Rival) -> tuple[str, ...]:
    return simplest(problem, null, [null, *rivals], CHANCE).names


def test_each_must_gain_what_others_could_feign(
    problem: Problem, null: Rival, bore: Candidate
) -> None:
    for one, needed in ((bore, LEAST_WRONG), (GAIN, LEAST_PLAIN), (THRESHOLD, LEAST)):
        assert _names(problem, null, _with(null, needed - 0.1, one)) == ()
        assert _names(problem, null, _with(null, needed + 0.1, one)) == (one.name,)


@pytest.mark.parametrize(
    ("effect", "most"),
    [
        (ForceSensorDrift(rate=0.01), LEAST_SLOW),
        (ChannelDelay(delay=0.05), LEAST_SLOW),
        (TemperatureStiffness(modulus=0.01), LEAST_SLOW),
        (Fatigue(loss=1e-3), LEAST_SLOW),
        (FirstCycle(gain=0.05), LEAST_SLOW),
        (Leak(rate=0.01), LEAST_SLOW),
        (CoulombFriction(magnitude=20.0), LEAST),
    ],
    ids=lambda value: getattr(value, "name", None),
)
def test_what_a_sound_sensor_may_do_slowly_must_gain_more(
    problem: Problem, effect: Effect, most: float
) -> None:
    assert least(problem, [Candidate(effect.name, effect)]) == most


def test_what_gains_too_little_holds_nothing_back(
    problem: Problem, null: Rival, bore: Candidate
) -> None:
    factor = _with(null, 7.0, GAIN)
    assert _names(problem, null, factor, _with(null, 6.0, bore)) == (bore.name,)
    assert _names(problem, null, _with(null, 9.0, GAIN), _with(null, 6.0, bore)) == (
        GAIN.name,
    )


def test_a_constant_believed_for_little_hides_no_pair(
    problem: Problem, null: Rival, bore: Candidate
) -> None:
    pair = _with(null, 20.0, THRESHOLD, FRICTION)
    names = (THRESHOLD.name, FRICTION.name)
    assert _names(problem, null, pair) == names
    assert _names(problem, null, pair, _with(null, 6.0, bore)) == names


def test_nor_does_it_make_a_pair_of_itself_and_another(
    problem: Problem, null: Rival, bore: Candidate
) -> None:
    weak, beside = _with(null, 6.0, bore), _with(null, 16.0, bore, THRESHOLD)
    assert _names(problem, null, weak, beside) == (bore.name,)


def test_one_that_gains_as_an_effect_does_must_be_beaten(
    problem: Problem, null: Rival, bore: Candidate
) -> None:
    pair = _with(null, 20.0, THRESHOLD, FRICTION)
    assert _names(problem, null, pair, _with(null, 14.0, bore)) == (bore.name,)
