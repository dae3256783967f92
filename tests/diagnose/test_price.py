from collections.abc import Callable

import numpy as np
import pytest

from gripperd.diagnose.candidates import Candidate
from gripperd.diagnose.point import Point
from gripperd.diagnose.polish import Polished
from gripperd.diagnose.price import acts_on, worth
from gripperd.diagnose.problem import Problem
from gripperd.diagnose.rival import Rival, added
from gripperd.diagnose.setup import problem_of
from gripperd.diagnose.temperature import louder
from gripperd.effects.coulomb_friction import CoulombFriction
from gripperd.effects.force_sensor_bias import ForceSensorBias
from gripperd.effects.pressure_sensor_bias import PressureSensorBias
from gripperd.effects.threshold_pressure import ThresholdPressure
from gripperd.effects.valve_offset import ValveOffset
from gripperd.model.effect import Signal
from gripperd.model.track import Array
from tests.diagnose.fitted import fitted
from tests.diagnose.small import MODEL, altered, moments, pinned, recording, rubbing


@pytest.mark.parametrize(
    ("candidate", "signals"),
    [
        (Candidate("c", CoulombFriction()), {Signal.FORCE}),
        (Candidate("v", ValveOffset()), {Signal.PRESSURE}),
        (Candidate("s", PressureSensorBias()), {Signal.FORCE, Signal.PRESSURE}),
        (Candidate("parameter:muscle.rest_length", None, 0), {Signal.FORCE}),
    ],
)
def test_a_candidate_acts_on_these_of_the_signals_explained(
    blank: Problem, candidate: Candidate, signals: set[Signal]
) -> None:
    assert blank.constants[0].path == "muscle.rest_length"
    assert acts_on(blank, candidate) == signals


def _rival(problem: Problem, *candidates: Candidate, misfit: float) -> Rival:
    """Explained so well, as if it had been fitted."""
    point = Point(np.zeros(len(problem.constants)))
    for one in candidates:
        point = added(point, one)
    misfits = {Signal.PRESSURE: 300.0, Signal.FORCE: misfit}
    size = len(problem.constants)
    counts = dict.fromkeys(misfits, 300)
    fit = Polished(point, 300.0 + misfit, misfits, counts, (), np.eye(size))
    return Rival(candidates, fit)


@pytest.mark.parametrize(("newtons", "seen"), [(1.0, False), (15.0, True)])
def test_a_further_effect_that_changes_no_reading_is_not_worth_its_price(
    blank: Problem, newtons: float, *, seen: bool
) -> None:
    # Full scale is 1.3 kN, of which sensors drift 3 N.
    rub = Candidate("coulomb_friction", CoulombFriction(magnitude=20.0))
    bias = Candidate("force_sensor_bias", ForceSensorBias(bias=newtons))
    null = _rival(blank, misfit=5000.0)
    best = _rival(blank, rub, misfit=2000.0)
    larger = _rival(blank, rub, bias, misfit=600.0)
    assert worth(blank, null, best, larger, 20.0) is seen
    # As the first effect it has to beat the noise, nothing else.
    assert worth(blank, null, null, _rival(blank, bias, misfit=600.0), 20.0)


@pytest.mark.parametrize(("misfit", "worth_it"), [(1850.0, False), (1600.0, True)])
def test_what_closes_little_of_the_first_gap_repairs_a_shape(
    blank: Problem, misfit: float, *, worth_it: bool
) -> None:
    # A further effect of some form must close 6 % of 3000 and more.
    creep = Candidate("threshold_pressure", ThresholdPressure(pressure=20e3))
    rub = Candidate("coulomb_friction", CoulombFriction(magnitude=20.0))
    null = _rival(blank, misfit=5000.0)
    best = _rival(blank, creep, misfit=2000.0)
    larger = _rival(blank, creep, rub, misfit=misfit)
    assert worth(blank, null, best, larger, 20.0) is worth_it


@pytest.mark.parametrize(("left", "worth_it"), [(320.0, True), (520.0, False)])
def test_what_leaves_but_noise_is_an_effect_of_its_own_though_it_closes_little(
    blank: Problem, left: float, *, worth_it: bool
) -> None:
    # 80 of 4700 are 1.7 %; 600 samples of noise have a misfit of 600 +- 35.
    creep = Candidate("threshold_pressure", ThresholdPressure(pressure=20e3))
    rub = Candidate("coulomb_friction", CoulombFriction(magnitude=20.0))
    null = _rival(blank, misfit=5000.0)
    best = _rival(blank, creep, misfit=left + 80.0)
    larger = _rival(blank, creep, rub, misfit=left)
    assert worth(blank, null, best, larger, 20.0) is worth_it


@pytest.mark.parametrize(("apart", "worth_it"), [(0.0, True), (35.0, False)])
def test_far_above_the_noise_an_addition_must_foretell_the_sweeps_it_never_saw(
    apart: float, *, worth_it: bool
) -> None:
    """The zero of the force is off by 15 N on average, and by as much each time or not.

    The mean of all gains as much in the fit, but that of the rest does not tell a sweep
    whose zero lies on the other side.
    """
    told = recording(rubbing(20.0))
    for place, name in enumerate(moments()):
        zero = 15.0 + apart * (-1) ** place
        told = altered(told, [name], "force", _off_by(zero))
    problem = pinned(problem_of(told, MODEL, {}), "muscle.diameter")
    problem = louder(problem, {Signal.FORCE: 5.0, Signal.PRESSURE: 1.0})
    rub = Candidate("coulomb_friction", CoulombFriction(magnitude=20.0))
    bias = Candidate("force_sensor_bias", ForceSensorBias(bias=5.0))
    null, best, larger = (fitted(problem, *one) for one in ((), (rub,), (rub, bias)))
    assert larger.evidence - best.evidence > 30.0
    assert worth(problem, null, best, larger, 20.0) is worth_it


def _off_by(zero: float) -> Callable[[Array], Array]:
    return lambda reading: reading + zero
