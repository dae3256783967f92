import numpy as np
import pytest

from gripperd.diagnose.fit.bending import bendable, bent
from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.setup import problem_of
from gripperd.effects.coulomb_friction import CoulombFriction
from gripperd.effects.force_sensor_bias import ForceSensorBias
from gripperd.effects.pressure_friction import PressureFriction
from gripperd.effects.threshold_pressure import ThresholdPressure
from gripperd.model.effect import Effect
from gripperd.model.track import Array
from tests.diagnose.fitted import fitted
from tests.diagnose.small import MODEL, Hidden, Moment, pinned, recording, threshold

RUB = CoulombFriction(magnitude=20.0)
THRESHOLD = ThresholdPressure(pressure=20e3)


def _rubbing(growth: float = 0.0) -> Hidden:
    """Dry friction of 60 N while it slides, which grows so much with pressure."""

    def lost(moment: Moment) -> Array:
        slides = np.ptp(moment.contraction) > 0
        grown = 1 + growth * moment.pressure / 500e3
        return -60.0 * slides * grown * moment.direction

    return lost


def _share(hidden: Hidden, first: Effect, further: Effect) -> float:
    """Share of a gain that is left when the first effect bends."""
    problem = problem_of(recording(hidden), MODEL, {})
    rests = (f"rest.{index}" for index in range(len(problem.courses)))
    problem = pinned(problem, "muscle.diameter", *rests)
    one, other = (Candidate(effect.name, effect) for effect in (first, further))
    best, larger = fitted(problem, one), fitted(problem, one, other)
    further_closed = best.fit.cost - larger.fit.cost
    assert further_closed > 50.0
    before, after = (bent(problem, rival, bendable(best)) for rival in (best, larger))
    return (before - after) / further_closed


def test_what_mends_a_form_has_nothing_left_once_that_bends() -> None:
    assert _share(_rubbing(0.3), RUB, PressureFriction()) < 0.2


@pytest.mark.parametrize("further", [THRESHOLD, ForceSensorBias(bias=5.0)])
def test_an_effect_of_its_own_keeps_what_it_closes(further: Effect) -> None:
    def both(moment: Moment) -> Array:
        return _rubbing()(moment) + threshold(10.0)(moment)

    assert _share(both, RUB, further) > 0.8


def test_what_has_but_one_form_does_not_bend() -> None:
    def off(moment: Moment) -> Array:
        return 20.0 + threshold(10.0)(moment)

    share = _share(off, ForceSensorBias(bias=5.0), THRESHOLD)
    assert share == pytest.approx(1.0, abs=0.02)


@pytest.mark.parametrize("effects", [(THRESHOLD,), (RUB,), (THRESHOLD, RUB)])
def test_unbent_an_explanation_leaves_what_its_fit_left(
    effects: tuple[Effect, ...],
) -> None:
    # Signs of friction at rest that end at 1 have nowhere to go from there.
    def both(moment: Moment) -> Array:
        return threshold(40.0)(moment) - 30.0 * moment.direction

    problem = problem_of(recording(both), MODEL, {})
    rival = fitted(problem, *(Candidate(one.name, one) for one in effects))
    assert bent(problem, rival, ()) == pytest.approx(rival.fit.cost, rel=1e-3)
