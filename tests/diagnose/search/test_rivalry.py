from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
import pytest

from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.fit.inflation import louder
from gripperd.diagnose.fit.polish import polished
from gripperd.diagnose.fit.rival import Rival, added
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.found import Found
from gripperd.diagnose.search.rivalry import (
    EVEN,
    SURE,
    Contest,
    Place,
    contest,
    standing_in,
)
from gripperd.diagnose.search.stepwise import search
from gripperd.diagnose.setup import problem_of
from gripperd.effects.coulomb_friction import CoulombFriction
from gripperd.effects.force_sensor_bias import ForceSensorBias
from gripperd.effects.force_sensor_gain import ForceSensorGain
from gripperd.effects.pressure_friction import PressureFriction
from gripperd.effects.threshold_pressure import ThresholdPressure
from gripperd.effects.valve_offset import ValveOffset
from gripperd.model.effect import Signal
from tests.diagnose.fitted import ended, fitted
from tests.diagnose.small import (
    MODEL,
    Hidden,
    altered,
    moments,
    pinned,
    recording,
    restless,
    rubbing,
    rubbing_more,
    textbook,
    threshold,
)


@dataclass(frozen=True, slots=True)
class Twin(CoulombFriction):
    """The same formula by another name: nobody can tell it apart."""

    name: ClassVar[str] = "twin"


@dataclass(frozen=True, slots=True)
class Third(CoulombFriction):
    """Nor this one."""

    name: ClassVar[str] = "third"


@dataclass(frozen=True, slots=True)
class Jump(CoulombFriction):
    """The same formula, which says itself that it is dry friction."""

    name: ClassVar[str] = "jump"

    @property
    def becomes(self) -> str:
        return "coulomb_friction"


RUB = Candidate("coulomb_friction", CoulombFriction(magnitude=20.0))
TWIN = Candidate("twin", Twin(magnitude=20.0))
JUMP = Candidate("jump", Jump(magnitude=20.0))
BIAS = Candidate("force_sensor_bias", ForceSensorBias(bias=5.0))
LATE = Candidate("threshold_pressure", ThresholdPressure(pressure=20e3))
GROWS = Candidate("pressure_friction", PressureFriction())
GAIN = Candidate("force_sensor_gain", ForceSensorGain(error=0.02))
BORE = Candidate("parameter:muscle.diameter", None, 0)


@pytest.fixture(scope="module")
def problem() -> Problem:
    rubbed = problem_of(recording(rubbing(20.0)), MODEL, {})
    return pinned(rubbed, "muscle.diameter", "zero.force")


def _found(problem: Problem, *listed: Candidate) -> Found:
    return search(problem, listed, np.random.default_rng(0))


def _believing(found: Found, *wrong: Candidate) -> Found:
    """A search that ended with something else."""
    point = found.null.fit.point
    for candidate in wrong:
        point = added(point, candidate)
    return replace(found, best=Rival(wrong, polished(found.problem, point)))


def test_twins_are_equivalent(problem: Problem) -> None:
    listed = (RUB, TWIN, BIAS)
    decided = contest(_found(problem, *listed), listed)
    (own,) = decided.best.names
    (others,) = decided.equivalents
    assert {own, *others} == {"coulomb_friction", "twin"}


def test_what_bears_its_name_by_no_right_is_no_equivalent(
    problem: Problem, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Twin, "is_misnamed", True)
    believed = _believing(_found(problem, RUB), RUB)
    assert contest(believed, (RUB, TWIN)).equivalents == ((),)


@pytest.mark.parametrize("own", [RUB, TWIN])
def test_a_twin_takes_no_place(problem: Problem, own: Candidate) -> None:
    # Which of them has been fitted a little further is up to the processor.
    believed = _believing(_found(problem, RUB), own)
    assert contest(believed, (RUB, TWIN)).best.names == (own.name,)


@pytest.mark.parametrize("own", [RUB, JUMP])
def test_what_has_become_another_effect_goes_by_its_name(
    problem: Problem, own: Candidate
) -> None:
    believed = _believing(_found(problem, RUB), own)
    decided = contest(believed, (RUB, JUMP))
    assert decided.best.names == ("coulomb_friction",)
    assert decided.equivalents == ((),)


def test_what_explains_less_is_no_equivalent(problem: Problem) -> None:
    listed = (RUB, BIAS)
    decided = contest(_found(problem, *listed), listed)
    assert decided.best.names == ("coulomb_friction",)
    assert decided.equivalents == ((),)


def test_a_better_rival_takes_the_place_of_a_wrong_choice(problem: Problem) -> None:
    listed = (RUB, BIAS)
    wrong = _believing(_found(problem, *listed), BIAS)
    assert contest(wrong, listed).best.names == ("coulomb_friction",)


def test_a_better_rival_that_but_mends_the_rest_takes_no_place() -> None:
    """A friction of another law than ours, and beside it a bias.

    One that grows with the pressure would fit far better than the bias, but is of no
    worth beside the friction.
    """
    problem = problem_of(recording(rubbing_more(0.2)), MODEL, {})
    listed = (RUB, GROWS, BIAS)
    wrong = _believing(_found(problem, RUB), RUB, BIAS)
    better = fitted(wrong.problem, RUB, GROWS)
    assert better.evidence > wrong.best.evidence + 100.0
    assert "pressure_friction" not in contest(wrong, listed).best.names


def test_what_the_rest_has_made_idle_is_dropped(problem: Problem) -> None:
    listed = (RUB, BIAS)
    wrong = _believing(_found(problem, *listed), BIAS, RUB)
    assert contest(wrong, listed).best.names == ("coulomb_friction",)


def test_the_best_without_an_effect_is_the_best_of_the_rest(problem: Problem) -> None:
    found = _found(problem, RUB)
    decided = contest(found, (RUB,))
    (place,) = decided.places
    assert place.without.names == ()
    assert place.without.evidence == pytest.approx(found.null.evidence, abs=0.5)
    assert decided.best.evidence - place.without.evidence > found.threshold


def test_nothing_found_has_no_rivals(blank: Problem) -> None:
    listed = (RUB, BIAS)
    decided = contest(_found(pinned(blank, "zero.force"), *listed), listed)
    assert (decided.best.names, decided.places) == ((), ())


def test_rivals_come_best_first_and_none_beats_the_best(problem: Problem) -> None:
    third = Candidate("third", Third(magnitude=20.0))
    listed = (RUB, TWIN, third)
    decided = contest(_found(problem, *listed), listed)
    (place,) = decided.places
    evidence = [one.evidence for one in place.rivals]
    assert len(evidence) == 2
    assert evidence == sorted(evidence, reverse=True)
    assert max(evidence) <= decided.best.evidence + EVEN


@pytest.mark.parametrize(("share", "kept"), [(0.04, True), (0.06, False)])
def test_a_rival_stands_in_that_leaves_a_twentieth_where_its_prior_asks_less(
    problem: Problem, share: float, *, kept: bool
) -> None:
    found = _found(problem, RUB)
    best, bare = found.best, found.null
    force = Signal.FORCE
    gained = bare.fit.misfits[force] - best.fit.misfits[force]
    assert 0.01 * gained > 4 * SURE
    left = {**best.fit.misfits, force: best.fit.misfits[force] + share * gained}
    rival = Rival((TWIN,), replace(best.fit, misfits=left))
    told = standing_in(found, Contest(best, (Place(bare, (rival,)),)))
    assert told.equivalents == ((("twin",) if kept else ()),)


@pytest.mark.parametrize(("one", "kept"), [(BORE, True), (BIAS, True), (RUB, False)])
def test_a_constant_is_not_told_from_a_factor_by_what_was_likely_before(
    problem: Problem, one: Candidate, *, kept: bool
) -> None:
    """4 nat less likely, though it fits as well: only what has a form pays for that."""
    found = _found(problem, RUB)
    best = Rival((GAIN,), found.best.fit)
    numbers = len(best.fit.covariance)
    narrower = best.fit.covariance * np.exp(-2 * 4.0 / numbers)
    rival = Rival((one,), replace(best.fit, covariance=narrower))
    assert best.evidence - rival.evidence == pytest.approx(4.0)
    told = standing_in(found, Contest(best, (Place(found.null, (rival,)),)))
    assert told.equivalents == (((one.name,) if kept else ()),)


@pytest.mark.parametrize(("deviations", "kept"), [(0.9, False), (3.0, True)])
def test_no_misfit_within_chance_excuses_a_rival(
    problem: Problem, deviations: float, *, kept: bool
) -> None:
    """It is 15 nat behind, less than half of chi² above its mean."""
    found = _found(problem, RUB)
    best, samples = found.best, found.best.fit.samples
    more = deviations * (2 * samples) ** 0.5 - best.excess
    force = best.fit.misfits[Signal.FORCE] + more
    misfits = {**best.fit.misfits, Signal.FORCE: force}
    best = replace(best, fit=replace(best.fit, misfits=misfits))
    cost = best.fit.cost + 2 * 15.0
    rival = Rival((TWIN,), replace(best.fit, cost=cost))
    assert 0.5 * deviations * (2 * samples) ** 0.5 > 15.0
    told = standing_in(found, Contest(best, (Place(found.null, (rival,)),)))
    assert told.equivalents == ((("twin",) if kept else ()),)


@pytest.mark.parametrize(("sweeps", "kept"), [(4, True), (5, False)])
def test_in_few_sweeps_a_rival_may_be_further_behind(
    problem: Problem, sweeps: int, *, kept: bool
) -> None:
    """By 4 nat: no whole sweep is left out that could tell the two apart."""
    found = _found(problem, RUB)
    best = found.best
    rival = Rival((TWIN,), replace(best.fit, cost=best.fit.cost + 2 * 4.0))
    few = replace(problem, courses=problem.courses[:sweeps])
    places = (Place(found.null, (rival,)),)
    told = standing_in(replace(found, problem=few), Contest(best, places))
    assert told.equivalents == ((("twin",) if kept else ()),)


def test_what_explains_another_signal_as_well_is_no_equivalent() -> None:
    # Friction shows in the force alone, and a valve that is off in the pressure alone.
    short = 0.016 * 4.4 / 500
    low = altered(
        recording(rubbing(6.0)), moments(), "current", lambda current: current + short
    )
    problem = pinned(problem_of(low, MODEL, {}), "muscle.diameter")
    valve = Candidate("valve_offset", ValveOffset(offset=2e3))
    best, other = fitted(problem, RUB), fitted(problem, valve)
    assert 5.0 < best.evidence - other.evidence < 20.0
    decided = contest(ended(problem, best), (RUB, valve, TWIN))
    assert decided.best.names == ("coulomb_friction",)
    assert decided.equivalents == (("twin",),)


def test_how_badly_a_force_fits_excuses_nothing_in_the_pressure() -> None:
    """A friction of an unlike law, and a valve that is off: no other friction is it."""
    high = altered(
        recording(rubbing_more(1.0)), moments(), "current", lambda one: one - 5e-5
    )
    problem = pinned(problem_of(high, MODEL, {}), "muscle.diameter")
    valve = Candidate("valve_offset", ValveOffset(offset=2e3))
    best = fitted(problem, RUB, valve)
    bare, other = fitted(problem, RUB), fitted(problem, RUB, TWIN)
    places = (Place(fitted(problem, valve)), Place(bare, (other,)))
    found = ended(problem, best)
    excess = best.fit.misfits[Signal.FORCE] - best.fit.counts[Signal.FORCE]
    closed = found.null.fit.cost - best.fit.cost
    behind = best.evidence - other.evidence
    assert 5.0 < behind < 0.5 * min(excess, 0.06 * closed)
    assert standing_in(found, Contest(best, places)).equivalents == ((), ())


def _loud(hidden: Hidden, inflated: float, **known: float) -> Problem:
    """A recording in which misfit, not noise, is what is weighed against."""
    told = recording(restless(hidden))
    tolerances = {f"muscle.{name}": sigma for name, sigma in known.items()}
    problem = pinned(problem_of(told, MODEL, tolerances), "muscle.diameter")
    return louder(problem, {Signal.FORCE: inflated, Signal.PRESSURE: 1.0})


@pytest.mark.parametrize(
    ("newtons", "told"),
    [(70.0, "force_sensor_bias"), (150.0, "coulomb_friction")],
)
def test_far_above_the_noise_what_a_limit_holds_back_takes_no_place(
    newtons: float, told: str
) -> None:
    # No sensor in use is off by more than 6.5 % of 1.4 kN.
    problem = _loud(lambda m: newtons + 0 * m.time, 25.0)
    decided = contest(ended(problem, fitted(problem, RUB)), (RUB, BIAS))
    assert decided.best.names == (told,)


def test_far_above_the_noise_a_mere_factor_does_not_take_the_place_of_the_bore() -> (
    None
):
    problem = _loud(
        lambda m: 0.94 * threshold(40.0)(m) - 0.06 * textbook(m), 12.0, diameter=1e-4
    )
    bore, factor = fitted(problem, LATE, BORE), fitted(problem, LATE, GAIN)
    assert factor.evidence > bore.evidence
    decided = contest(ended(problem, bore), (LATE, BORE, GAIN))
    assert decided.best.names == bore.names


@pytest.mark.parametrize(
    ("factor", "noise", "bore"),
    [(1.06, 3.0, False), (1.10, 3.0, True), (1.13, 0.3, False)],
)
def test_a_factor_at_its_limit_gives_way_to_what_does_nearly_as_well(
    factor: float, noise: float, *, bore: bool
) -> None:
    """No cell is off by more than 8 %; with little noise the bore does far worse."""
    louder_cell = altered(
        recording(noise=noise), moments(), "force", lambda force: factor * force
    )
    problem = problem_of(louder_cell, MODEL, {"muscle.diameter": 2e-4})
    paths = [one.path for one in problem.constants]
    gain = Candidate("force_sensor_gain", ForceSensorGain(error=0.05))
    wrong = Candidate("parameter:muscle.diameter", None, paths.index("muscle.diameter"))
    found = ended(problem, fitted(problem, gain))
    told = contest(found, [gain, wrong])
    assert found.best.evidence > fitted(problem, wrong).evidence
    assert told.best.names == ((wrong if bore else gain).name,)
    assert not (bore and any(told.equivalents))
