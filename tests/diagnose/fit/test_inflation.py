from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.fit.inflation import deflated, louder, plain, reached
from gripperd.diagnose.fit.polish import Polished
from gripperd.diagnose.noise.model import Noise
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.stepwise import search
from gripperd.diagnose.setup import problem_of
from gripperd.model.effect import Signal
from gripperd.model.track import Array
from tests.diagnose.fitted import fitted
from tests.diagnose.searched import LISTED, OPEN
from tests.diagnose.small import (
    FORCE_NOISE,
    MODEL,
    altered,
    moments,
    nothing,
    pinned,
    recording,
)


def _fit(blank: Problem, **shares: float) -> Polished:
    """Leaves these mean squares of signals of 100 samples each."""
    misfits = {Signal(name): 100 * share for name, share in shares.items()}
    point = Point(np.zeros(len(blank.constants)))
    counts = dict.fromkeys(misfits, 100)
    nothing = np.empty((0, 0))
    return Polished(point, 0.0, misfits, counts, (), nothing, nothing)


@pytest.mark.parametrize(
    ("share", "loudness"), [(0.4, 1.0), (0.6, 1.0), (0.7, 1.4), (1.2, 2.0), (1.5, 3.0)]
)
def test_a_noise_taken_twice_as_loud_turns_out_as_the_best_fit_leaves_it(
    blank: Problem, share: float, loudness: float
) -> None:
    # Up to 1.3 of the true noise is reached by the noise alone.
    fits = [_fit(blank, force=share), _fit(blank, force=4.0)]
    found = reached({Signal.FORCE: 2.0}, fits)
    assert found == {Signal.FORCE: pytest.approx(loudness)}


def test_but_the_chosen_signals_lose_their_memory(blank: Problem) -> None:
    laws = {
        signal: replace(noise, correlation=0.4, drift=noise.std)
        for signal, noise in blank.noises.items()
    }
    problem = plain(replace(blank, noises=laws), [Signal.PRESSURE])
    force, pressure = (problem.noises[s] for s in (Signal.FORCE, Signal.PRESSURE))
    assert force == laws[Signal.FORCE]
    assert pressure.std == laws[Signal.PRESSURE].std
    assert pressure.correlation == 0.0
    assert pressure.drift < 0.01 * pressure.std


def _restless(current: Array) -> Array:
    """off by 0.3 mA of 16, to and fro in 12 s: 10 times the noise of the pressure."""
    return current + 0.3e-3 * np.sin(np.arange(current.size) / 8)


def test_a_stage_far_from_its_model_leaves_the_noise_of_the_others_as_it_was() -> None:
    told = altered(recording(nothing), moments(), "current", _restless)
    problem = pinned(problem_of(told, MODEL, {}), *OPEN)
    found = search(problem, LISTED, np.random.default_rng(0))
    assert found.problem.inflations[Signal.PRESSURE] > 2.0
    assert found.problem.noises[Signal.FORCE] == problem.noises[Signal.FORCE]
    assert found.best.names == ()


@pytest.fixture(scope="module")
def problem() -> Problem:
    """Nothing is hidden, and the force has white noise of 3 N."""
    known = pinned(problem_of(recording(nothing), MODEL, {}), "muscle.diameter")
    white = {s: Noise(one.std, 0.0, 1e-3) for s, one in known.noises.items()}
    return replace(known, noises={**white, Signal.FORCE: Noise(FORCE_NOISE, 0.0)})


def test_what_an_explanation_reaches_is_no_louder_than_it_leaves(
    problem: Problem,
) -> None:
    inflated = louder(problem, {Signal.FORCE: 100.0, Signal.PRESSURE: 1.0})
    calm = deflated(inflated, fitted(inflated).fit)
    assert calm.noises[Signal.FORCE].std == pytest.approx(FORCE_NOISE, rel=0.1)
    assert calm.inflations[Signal.FORCE] == pytest.approx(1.0, abs=0.2)


def test_cooling_goes_no_further_than_the_noise(problem: Problem) -> None:
    still = replace(problem, noises={**problem.noises, Signal.FORCE: Noise(30.0, 0.0)})
    inflated = louder(still, {Signal.FORCE: 4.0, Signal.PRESSURE: 1.0})
    calm = deflated(inflated, fitted(inflated).fit)
    assert calm.noises[Signal.FORCE].std == pytest.approx(30.0)
    assert calm.inflations[Signal.FORCE] == pytest.approx(1.0)


def test_cooling_never_heats(problem: Problem) -> None:
    quiet = replace(problem, noises={**problem.noises, Signal.FORCE: Noise(0.3, 0.0)})
    same = louder(quiet, {Signal.FORCE: 2.0, Signal.PRESSURE: 1.0})
    assert deflated(same, fitted(same).fit).inflations[Signal.FORCE] == 2.0
