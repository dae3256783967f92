"""Constants that lie beyond tolerances stated too tight."""

from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.diagnosis import Diagnosis, diagnose
from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.fit.rival import Rival
from gripperd.diagnose.search.rivalry import SURE, Contest, Place
from gripperd.diagnose.search.tolerances import with_usual_tolerances
from gripperd.diagnose.statement import statement, summary
from gripperd.diagnose.verdict.conclude import Verdict
from gripperd.diagnose.verdict.gap import Gap
from gripperd.effects import EFFECTS
from gripperd.effects.valve_gain import ValveGain
from tests.diagnose.small import (
    MODEL,
    MUSCLE,
    REGULATOR,
    Hidden,
    nothing,
    recording,
    threshold,
)

LIBRARY = {
    name: EFFECTS[name]
    for name in ("threshold_pressure", "tapered_ends", "valve_gain", "valve_offset")
}
BORE = "parameter:muscle.diameter"
SPAN = "parameter:valve.pressure_high"
TIGHT = 0.005


def _told(
    bore: float, span: float, hidden: Hidden = nothing, tolerance: float = TIGHT
) -> Diagnosis:
    """A model whose bore and span are off by so much, and the tolerance it states."""
    diameter = MUSCLE.diameter * (1 + bore)
    high = REGULATOR.pressure_high * (1 + span)
    model = replace(
        MODEL,
        muscle=replace(MUSCLE, diameter=diameter),
        regulator=replace(REGULATOR, pressure_high=high),
    )
    stated = {
        "muscle.rest_length": tolerance * MUSCLE.rest_length,
        "muscle.diameter": tolerance * diameter,
        "muscle.braid_angle": 1e-5,
        "valve.pressure_high": tolerance * high,
    }
    return diagnose(recording(hidden), model, stated, LIBRARY)


@pytest.fixture(scope="module")
def both() -> Diagnosis:
    return _told(0.02, -0.02)


def test_several_constants_beyond_their_tolerance_are_no_effect(
    both: Diagnosis,
) -> None:
    assert both.verdict is Verdict.NAMED
    assert {entry.name for entry in both.named} == {BORE, SPAN}


def test_they_are_told_as_they_were_built(both: Diagnosis) -> None:
    entries = {entry.name: entry for entry in both.named}
    bore = entries[BORE].parameters["diameter"].value
    span = entries[SPAN].parameters["pressure_high"].value
    assert bore == pytest.approx(MUSCLE.diameter, rel=0.003)
    assert span == pytest.approx(REGULATOR.pressure_high, rel=0.003)


def test_it_is_said_that_the_tolerances_are_too_tight(both: Diagnosis) -> None:
    assert "tolerances tighter than its parts keep" in summary(both)
    assert statement(both, both.named[0]).endswith(
        "correct the model and its tolerance."
    )


def test_they_are_one_finding(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        Gap, "confirms", lambda _gap, effects, *, exact: effects == 1 and not exact
    )
    assert _told(0.02, -0.02).verdict is Verdict.NAMED


def test_one_alone_is_what_shows_in_its_way() -> None:
    assert [entry.name for entry in _told(0.0, -0.02).named] == ["valve_gain"]


def test_an_effect_is_told_whatever_the_tolerances() -> None:
    found = _told(0.0, 0.0, threshold(25))
    assert [entry.name for entry in found.named] == ["threshold_pressure"]


GAIN = Candidate("valve_gain", ValveGain())


def _behind(both: Diagnosis, lead: float, told: Candidate = GAIN) -> Contest:
    """A contest that the constants lead by so much."""
    fit = both.contest.best.fit
    rival = Rival((told,), replace(fit, cost=fit.cost + 2 * lead))
    return Contest(rival, (Place(both.found.null),))


def test_an_effect_that_explains_as_much_stays_a_rival(both: Diagnosis) -> None:
    told = with_usual_tolerances(both.found, _behind(both, 0.5 * SURE))
    assert told.equivalents[0] == ("valve_gain",)
    assert not any(told.equivalents[1:])


@pytest.mark.parametrize("lead", [-0.5 * SURE, 0.5 * SURE])
def test_one_part_that_explains_as_much_as_several_is_told_alone(
    both: Diagnosis, lead: float
) -> None:
    index = [one.path for one in both.found.problem.constants].index("muscle.diameter")
    best = _behind(both, lead, Candidate(BORE, None, index))
    told = with_usual_tolerances(both.found, best)
    assert told.best.names == ((BORE,) if lead < 0 else both.contest.best.names)
    assert not any(told.equivalents)


def test_an_effect_that_explains_less_is_none(both: Diagnosis) -> None:
    told = with_usual_tolerances(both.found, _behind(both, 2 * SURE))
    assert not any(told.equivalents)


def test_one_part_that_is_far_off_pays_for_that_no_more_than_several(
    both: Diagnosis,
) -> None:
    """It would explain more than they do, were it not off by 8 tolerances."""
    fit, constants = both.contest.best.fit, both.found.problem.constants
    index = [one.path for one in constants].index("muscle.diameter")
    shifts = np.zeros_like(fit.point.shifts)
    shifts[index] = 8.0
    point = replace(fit.point, shifts=shifts, looser=(), freed=frozenset({index}))
    alone = replace(fit, point=point, cost=fit.cost - 3 * SURE)
    rival = Rival((Candidate(BORE, None, index),), alone)
    assert point.surprise > 0.5 * SURE
    best = Contest(rival, (Place(both.found.null),))
    assert with_usual_tolerances(both.found, best) is best


def test_an_effect_that_explains_more_is_kept(both: Diagnosis) -> None:
    best = _behind(both, -2 * SURE)
    assert with_usual_tolerances(both.found, best) is best


def test_tolerances_that_parts_keep_are_not_doubted(both: Diagnosis) -> None:
    problem = both.found.problem
    kept = tuple(
        replace(one, sigma=max(one.sigma, one.usual)) for one in problem.constants
    )
    found = replace(both.found, problem=replace(problem, constants=kept))
    best = _behind(both, 2 * SURE)
    assert with_usual_tolerances(found, best) is best
