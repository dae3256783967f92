from dataclasses import replace

import pytest

from gripperd.diagnose.noise import Noise
from gripperd.diagnose.problem import Problem
from gripperd.diagnose.setup import problem_of
from gripperd.diagnose.temperature import cooled, louder
from gripperd.model.effect import Signal
from tests.diagnose.fitted import fitted
from tests.diagnose.small import FORCE_NOISE, MODEL, nothing, pinned, recording


@pytest.fixture(scope="module")
def problem() -> Problem:
    """Nothing is hidden, and the force has white noise of 3 N."""
    plain = pinned(problem_of(recording(nothing), MODEL, {}), "muscle.diameter")
    white = {s: Noise(one.std, 0.0, 1e-3) for s, one in plain.noises.items()}
    return replace(plain, noises={**white, Signal.FORCE: Noise(FORCE_NOISE, 0.0)})


def test_what_an_explanation_reaches_is_no_louder_than_it_leaves(
    problem: Problem,
) -> None:
    hot = louder(problem, {Signal.FORCE: 100.0, Signal.PRESSURE: 1.0})
    cool = cooled(hot, fitted(hot).fit)
    assert cool.noises[Signal.FORCE].std == pytest.approx(FORCE_NOISE, rel=0.1)
    assert cool.temperatures[Signal.FORCE] == pytest.approx(1.0, abs=0.2)


def test_cooling_goes_no_further_than_the_noise(problem: Problem) -> None:
    still = replace(problem, noises={**problem.noises, Signal.FORCE: Noise(30.0, 0.0)})
    hot = louder(still, {Signal.FORCE: 4.0, Signal.PRESSURE: 1.0})
    cool = cooled(hot, fitted(hot).fit)
    assert cool.noises[Signal.FORCE].std == pytest.approx(30.0)
    assert cool.temperatures[Signal.FORCE] == pytest.approx(1.0)


def test_cooling_never_heats(problem: Problem) -> None:
    quiet = replace(problem, noises={**problem.noises, Signal.FORCE: Noise(0.3, 0.0)})
    same = louder(quiet, {Signal.FORCE: 2.0, Signal.PRESSURE: 1.0})
    assert cooled(same, fitted(same).fit).temperatures[Signal.FORCE] == 2.0
