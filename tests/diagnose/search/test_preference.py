from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.fit.polish import Polished
from gripperd.diagnose.fit.rival import Rival, added
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.preference import at_edge, preferred, strained
from gripperd.effects.force_sensor_gain import ForceSensorGain
from gripperd.effects.tapered_ends import TaperedEnds
from gripperd.effects.threshold_pressure import ThresholdPressure
from gripperd.model.effect import Signal

LATE = Candidate("threshold_pressure", ThresholdPressure(pressure=20e3))
TAPERED = Candidate("tapered_ends", TaperedEnds(excess=0.1))
AT_LIMIT = Candidate("tapered_ends", TaperedEnds(excess=-0.3))
GAIN = Candidate("force_sensor_gain", ForceSensorGain(error=0.05))
BORE = Candidate("parameter:muscle.diameter", None, 1)


def _rival(problem: Problem, *candidates: Candidate, cost: float) -> Rival:
    """Explained so well, as if it had been fitted."""
    point = Point(np.zeros(len(problem.constants)))
    for one in candidates:
        point = added(point, one)
    held = np.eye(len(problem.constants))
    counts = {Signal.FORCE: 300}
    fit = Polished(point, cost, {Signal.FORCE: cost}, counts, (), held, 0 * held)
    return Rival(candidates, fit)


@pytest.fixture
def inflated(blank: Problem) -> Problem:
    """A recording that nothing explains down to its noise."""
    return replace(blank, inflations={Signal.FORCE: 40.0, Signal.PRESSURE: 1.0})


def test_near_the_noise_the_likeliest_is_believed(blank: Problem) -> None:
    better = _rival(blank, AT_LIMIT, cost=300.0)
    assert preferred(blank, [better, _rival(blank, LATE, cost=310.0)]) is better


def test_far_above_it_what_no_limit_holds_back_is_believed_if_it_fits_alike(
    inflated: Problem,
) -> None:
    held = _rival(inflated, AT_LIMIT, cost=300.0)
    alike, worse = (
        _rival(inflated, LATE, cost=360.0),
        _rival(inflated, LATE, cost=390.0),
    )
    assert preferred(inflated, [held, alike]) is alike
    assert preferred(inflated, [held, worse]) is held


def test_the_bore_is_told_before_a_mere_factor_that_fits_alike(
    inflated: Problem,
) -> None:
    factor = _rival(inflated, LATE, GAIN, cost=300.0)
    bore = _rival(inflated, LATE, BORE, cost=320.0)
    assert preferred(inflated, [factor, bore]) is bore
    assert (
        preferred(inflated, [factor, _rival(inflated, LATE, BORE, cost=390.0)])
        is factor
    )


def test_the_bore_is_not_told_before_an_effect_with_a_form(inflated: Problem) -> None:
    formed = _rival(inflated, LATE, TAPERED, cost=300.0)
    assert (
        preferred(inflated, [formed, _rival(inflated, LATE, BORE, cost=320.0)])
        is formed
    )


def _edged(problem: Problem, rival: Rival, share: float) -> Rival:
    """The same with the bore at a share of its tolerance."""
    shifts = rival.fit.point.shifts.copy()
    shifts[1] = -share * problem.reach(rival.fit.point)[1]
    point = replace(rival.fit.point, shifts=shifts)
    return replace(rival, fit=replace(rival.fit, point=point))


def test_the_bore_is_told_before_a_form_that_leaves_it_at_its_edge(
    inflated: Problem,
) -> None:
    formed = _rival(inflated, LATE, TAPERED, cost=300.0)
    bore = _rival(inflated, LATE, BORE, cost=450.0)
    assert inflated.constants[1].path == "muscle.diameter"
    edged = _edged(inflated, formed, 1.0)
    assert at_edge(inflated, edged) == ("parameter:muscle.diameter",)
    assert preferred(inflated, [edged, bore]) is bore
    assert (
        preferred(inflated, [_edged(inflated, formed, 0.9), bore]).names == formed.names
    )
    worse = _rival(inflated, LATE, BORE, cost=500.0)
    assert preferred(inflated, [edged, worse]) is edged


@pytest.mark.parametrize(("candidate", "held"), [(TAPERED, False), (AT_LIMIT, True)])
def test_an_amplitude_at_its_limit_is_held_back(
    blank: Problem, candidate: Candidate, *, held: bool
) -> None:
    assert strained(blank, _rival(blank, candidate, cost=300.0)) is held
