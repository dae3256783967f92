from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.fit.inflation import louder
from gripperd.diagnose.fit.polish import polished
from gripperd.diagnose.fit.rival import Rival
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.search import loop, rivalry
from gripperd.diagnose.search.loop import discernible, is_but_curve, shows_its_loop
from gripperd.diagnose.search.rivalry import contest
from gripperd.diagnose.search.stepwise import additions, search
from gripperd.diagnose.setup import problem_of
from gripperd.effects.coulomb_friction import CoulombFriction
from gripperd.effects.creep import Creep, Holding
from gripperd.effects.force_sensor_bias import ForceSensorBias
from gripperd.effects.force_sensor_drift import ForceSensorDrift
from gripperd.effects.nonlinear_elasticity import NonlinearElasticity
from gripperd.effects.presliding_hysteresis import PreslidingHysteresis
from gripperd.effects.pressure_hysteresis import PressureHysteresis
from gripperd.model.effect import Effect, Signal
from gripperd.model.preisach import Hysteron
from gripperd.model.track import Array
from tests.diagnose.fitted import ended, fitted
from tests.diagnose.small import MODEL, Hidden, Moment, recording, switched

RELAY = Hysteron.RELAY
OF_WAY = PreslidingHysteresis(hysteron=RELAY, relays=10.0, curve=1.0)
OF_PRESSURE = PressureHysteresis(hysteron=RELAY, relays=10.0, centre=350e3, curve=1.0)


def _bank(signal: Array, middle: float, spread: float, half: float) -> Array:
    """Share of a bank of relays that is up, each switched by itself."""
    middles = np.random.default_rng(3).normal(middle, spread, 400)
    return switched(signal, middles, half)


def bank_of_way(half: float) -> Hidden:
    """Give up to 60 N by relays over contraction so wide, or without a loop."""
    return lambda moment: 60.0 * _bank(moment.contraction, 0.08, 0.05, half)


def bank_of_pressure(half: float) -> Hidden:
    """Give as much by relays over pressure."""
    return lambda moment: 60.0 * _bank(moment.pressure, 250e3, 80e3, half)


@pytest.mark.parametrize(
    ("hidden", "effect", "is_seen"),
    [
        (bank_of_way(0.02), OF_WAY, True),
        (bank_of_way(0.0), OF_WAY, False),
        (bank_of_pressure(40e3), OF_PRESSURE, True),
        (bank_of_pressure(0.0), OF_PRESSURE, False),
        (bank_of_pressure(24e3), OF_PRESSURE, True),
        (bank_of_way(0.0), PreslidingHysteresis(near=10.0), True),
    ],
)
def test_relays_show_a_loop_where_there_is_one_and_springs_are_nothing_else(
    hidden: Hidden, effect: Effect, *, is_seen: bool
) -> None:
    problem = problem_of(recording(hidden), MODEL, {})
    start = Point(np.zeros(len(problem.constants)), (effect,))
    told = Rival((Candidate(effect.name, effect),), polished(problem, start))
    assert shows_its_loop(problem, told) is is_seen


def _chain(moment: Moment) -> Array:
    """A chain near the end of its stretch: no curve of the library bends so."""
    return -60.0 * moment.contraction / (0.25 - moment.contraction)


def _stop(moment: Moment) -> Array:
    """A soft stop that sets in at once."""
    return -2000.0 * np.maximum(moment.contraction - 0.1, 0.0)


@pytest.mark.parametrize("hidden", [_chain, _stop])
def test_a_curve_that_bends_as_the_edge_of_a_loop_shows_none(hidden: Hidden) -> None:
    """Relays that switch beyond its ends have it, and those in their place do not."""
    problem = problem_of(recording(hidden), MODEL, {})
    start = Point(np.zeros(len(problem.constants)), (OF_WAY,))
    told = Rival((Candidate(OF_WAY.name, OF_WAY),), polished(problem, start))
    (relays,) = told.fit.point.effects
    assert relays.forgetful is not relays
    assert not shows_its_loop(problem, told)


@pytest.mark.parametrize(("half", "is_seen"), [(24e3, False), (80e3, True)])
def test_a_loop_the_wrong_way_round_is_most_of_what_there_is(
    half: float, *, is_seen: bool
) -> None:
    """Relays that take force give work: less falls away going up than coming down."""
    taken = bank_of_pressure(half)
    problem = problem_of(recording(lambda moment: -taken(moment)), MODEL, {})
    start = Point(np.zeros(len(problem.constants)), (replace(OF_PRESSURE, relays=-10),))
    told = Rival((Candidate(OF_PRESSURE.name, OF_PRESSURE),), polished(problem, start))
    assert shows_its_loop(problem, told) is is_seen


@pytest.mark.parametrize(("half", "found"), [(40e3, True), (0.0, False)])
def test_what_has_no_loop_is_not_found(half: float, *, found: bool) -> None:
    problem = problem_of(recording(bank_of_pressure(half)), MODEL, {})
    listed = [Candidate(OF_PRESSURE.name, OF_PRESSURE)]
    told = search(problem, listed, np.random.default_rng(0)).best.names
    assert told == ((OF_PRESSURE.name,) if found else ())


@pytest.mark.parametrize(("times", "heard"), [(90.0, True), (110.0, False)])
def test_some_are_not_heard_where_misfit_is_far_too_large(
    times: float, *, heard: bool
) -> None:
    """Ten times as loud as the noise, a mean square of a hundred.

    They are relays, and creep beside a model that means no settled muscle.
    """
    problem = problem_of(recording(), MODEL, {})
    far = louder(problem, {Signal.FORCE: times, Signal.PRESSURE: 1.0})
    from_here = Creep(slow=0.02, holds=Holding.AT_ONCE)
    some = [Candidate(one.name, one) for one in (OF_WAY, OF_PRESSURE, from_here)]
    springs = PreslidingHysteresis(near=10.0)
    others = [
        Candidate(springs.name, springs),
        LATE,
        Candidate("parameter:muscle.diameter", None, 1),
    ]
    told = discernible(far, [*some, *others])
    assert told == ([*some, *others] if heard else others)
    assert discernible(problem, some) == some


@pytest.mark.parametrize(("far", "found"), [(30.0, True), (10.0, False)])
def test_relays_beside_much_else_are_not_found(
    monkeypatch: pytest.MonkeyPatch, far: float, *, found: bool
) -> None:
    """They give 300 N; a wave that no library holds leaves 17 squares of the noise."""

    def lost(moment: Moment) -> Array:
        return 5 * bank_of_pressure(80e3)(moment) + 60.0 * np.sin(moment.time)

    monkeypatch.setattr(loop, "FAR", far)
    problem = problem_of(recording(lost), MODEL, {})
    listed = [Candidate(OF_PRESSURE.name, OF_PRESSURE)]
    told = search(problem, listed, np.random.default_rng(0)).best.names
    assert told == ((OF_PRESSURE.name,) if found else ())


@pytest.mark.parametrize(("far", "heard"), [(20.0, True), (5.0, False)])
def test_relays_are_neither_added_nor_challenge_far_above_the_noise(
    monkeypatch: pytest.MonkeyPatch, far: float, *, heard: bool
) -> None:
    """Beside a bias, and in its place."""
    monkeypatch.setattr(loop, "FAR", far)
    hidden = bank_of_pressure(80e3)
    problem = problem_of(recording(lambda moment: 4 * hidden(moment)), MODEL, {})
    problem = louder(problem, {Signal.FORCE: 10.0, Signal.PRESSURE: 1.0})
    bias = Candidate("force_sensor_bias", ForceSensorBias())
    listed = [bias, Candidate(OF_PRESSURE.name, OF_PRESSURE)]
    found = ended(problem, fitted(problem, bias))
    assert bool(additions(found, found.best, listed, 4)) is heard
    assert (OF_PRESSURE.name in contest(found, listed).best.names) is heard


CURVE = Candidate("nonlinear_elasticity", NonlinearElasticity(saturation=10.0))
RELAYS = Candidate("presliding_hysteresis", OF_WAY)
RUB = Candidate("coulomb_friction", CoulombFriction(magnitude=20.0))
LATE = Candidate("creep", Creep(slow=0.02, time=12.0))
DRIFT = Candidate("force_sensor_drift", ForceSensorDrift(rate=0.01))
SPRINGS = Candidate("presliding_hysteresis", PreslidingHysteresis(near=10.0))


@pytest.mark.parametrize(
    ("own", "other", "lead", "is_curve"),
    [
        (RELAYS, CURVE, 12.0, True),
        (RELAYS, CURVE, 14.0, False),
        (RELAYS, RUB, 12.0, False),
        (SPRINGS, CURVE, 12.0, False),
        (LATE, CURVE, 12.0, True),
        (LATE, CURVE, 14.0, False),
        (LATE, RUB, 12.0, False),
        (LATE, DRIFT, 12.0, False),
        (DRIFT, CURVE, 12.0, False),
        (CURVE, RELAYS, 12.0, False),
    ],
)
def test_a_memory_must_be_likelier_than_what_has_none(
    own: Candidate, other: Candidate, lead: float, *, is_curve: bool
) -> None:
    problem = problem_of(recording(bank_of_way(0.02)), MODEL, {})
    rival, plain = fitted(problem, own), fitted(problem, other)
    cost = rival.fit.cost + 2 * (rival.evidence - plain.evidence - lead)
    rival = replace(rival, fit=replace(rival.fit, cost=cost))
    assert is_but_curve(rival, plain) is is_curve


@pytest.mark.parametrize("first", [RELAYS, CURVE], ids=["loop", "curve"])
@pytest.mark.parametrize(("hardly", "told"), [(True, CURVE), (False, RELAYS)])
def test_a_loop_that_is_hardly_likelier_than_a_curve_is_that_curve(
    monkeypatch: pytest.MonkeyPatch, first: Candidate, told: Candidate, *, hardly: bool
) -> None:
    monkeypatch.setattr(
        rivalry,
        "is_but_curve",
        lambda rival, other: (
            hardly and RELAYS in {*rival.candidates} - {*other.candidates}
        ),
    )
    problem = problem_of(recording(bank_of_way(0.02)), MODEL, {})
    found = ended(problem, fitted(problem, first))
    done = contest(found, [RELAYS, CURVE])
    assert done.best.candidates == (told,)
    assert done.equivalents == ((),)
