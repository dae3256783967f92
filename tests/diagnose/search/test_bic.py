from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.fit.rival import Rival
from gripperd.diagnose.noise.model import Noise
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.bic import STRONG, delta_bic
from gripperd.diagnose.search.needed import needed
from gripperd.diagnose.search.price import worth
from gripperd.diagnose.setup import problem_of
from gripperd.effects.coulomb_friction import CoulombFriction
from gripperd.effects.force_sensor_bias import ForceSensorBias
from gripperd.model.effect import Signal
from tests.diagnose.fitted import fitted
from tests.diagnose.small import MODEL, pinned, recording, rubbing

BIAS = Candidate("force_sensor_bias", ForceSensorBias(bias=5.0))
RUB = Candidate("coulomb_friction", CoulombFriction(magnitude=20.0))
BORE = "parameter:muscle.diameter"


@pytest.fixture(scope="module")
def problem() -> Problem:
    """A cell that reads 10 N too much, noise without memory, and nothing to adjust."""
    known = pinned(problem_of(recording(lambda at: 10.0 + 0 * at.time), MODEL, {}))
    quick = {signal: Noise(one.std, 0.0) for signal, one in known.noises.items()}
    return replace(known, noises=quick)


def test_it_falls_by_what_a_mean_explains_less_the_log_of_the_samples(
    problem: Problem,
) -> None:
    places = [b.signal is Signal.FORCE for b in problem.blocks]
    left = np.concatenate(
        [
            residual
            for residual, own in zip(
                problem.residuals(fitted(problem).fit.point), places, strict=True
            )
            if own
        ]
    )
    samples = sum(block.good.sum() for block in problem.blocks)
    explained = left.size * (left.mean() / problem.noises[Signal.FORCE].std) ** 2
    change = delta_bic(problem, fitted(problem, BIAS), fitted(problem))
    assert change == pytest.approx(np.log(samples) - explained, rel=0.02)


def test_samples_that_repeat_each_other_count_less(problem: Problem) -> None:
    """Of a noise with r = 0.6 four as much as one."""
    fits = fitted(problem, BIAS), fitted(problem)
    slow = {s: Noise(one.std, 0.6) for s, one in problem.noises.items()}
    lasting = replace(problem, noises=slow)
    cheaper = delta_bic(problem, *fits) - delta_bic(lasting, *fits)
    assert cheaper == pytest.approx(np.log(4.0), rel=1e-6)


def _behind(problem: Problem, told: Rival, bare: Rival, change: float) -> Rival:
    """Give it without something so much that the BIC changes by so much."""
    more = delta_bic(problem, told, bare) - change
    return replace(bare, fit=replace(bare.fit, cost=bare.fit.cost + more))


@pytest.mark.parametrize(("change", "kept"), [(STRONG - 0.1, True), (-9.0, False)])
def test_what_is_told_has_very_strong_evidence(
    problem: Problem, change: float, *, kept: bool
) -> None:
    told = fitted(problem, BIAS, RUB)
    bare = fitted(problem, RUB), _behind(problem, told, fitted(problem, BIAS), change)
    names = needed(problem, told, bare, -np.inf)[0].names
    assert names == ((BIAS.name, RUB.name) if kept else (BIAS.name,))


@pytest.mark.parametrize(("change", "paid"), [(STRONG - 0.1, True), (-9.0, False)])
def test_so_has_a_first(problem: Problem, change: float, *, paid: bool) -> None:
    told = fitted(problem, BIAS)
    null = _behind(problem, told, fitted(problem), change)
    assert worth(problem, null, null, told, -np.inf) is paid


def test_a_constant_is_believed_for_less() -> None:
    """Its price is paid by evidence: nothing is new but a number."""
    open_bore = pinned(
        problem_of(recording(rubbing(30.0)), MODEL, {}), "muscle.diameter"
    )
    wrong = Candidate(BORE, None, 0)
    told = fitted(open_bore, wrong, RUB)
    bare = _behind(open_bore, told, fitted(open_bore, RUB), -5.0)
    both = bare, fitted(open_bore, wrong)
    assert needed(open_bore, told, both, -np.inf)[0] is told
