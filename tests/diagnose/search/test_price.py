from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.fit.inflation import louder
from gripperd.diagnose.fit.rival import Rival
from gripperd.diagnose.readings.recording import Recording
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search import price
from gripperd.diagnose.search.price import LEAST_MORE, acts_on, worth
from gripperd.diagnose.setup import problem_of
from gripperd.effects.coulomb_friction import CoulombFriction
from gripperd.effects.force_sensor_bias import ForceSensorBias
from gripperd.effects.force_sensor_drift import ForceSensorDrift
from gripperd.effects.force_sensor_gain import ForceSensorGain
from gripperd.effects.pressure_friction import PressureFriction
from gripperd.effects.pressure_sensor_bias import PressureSensorBias
from gripperd.effects.pressure_sensor_gain import PressureSensorGain
from gripperd.effects.threshold_pressure import ThresholdPressure
from gripperd.effects.valve_gain import ValveGain
from gripperd.effects.valve_offset import ValveOffset
from gripperd.model.effect import Signal
from gripperd.model.track import Array
from tests.diagnose.fitted import fitted
from tests.diagnose.small import (
    LINKAGE,
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
    with_grip,
    without,
)


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


JAWED = replace(MODEL, linkage=LINKAGE)
BIAS = Candidate("force_sensor_bias", ForceSensorBias(bias=5.0))
DRIFT = Candidate("force_sensor_drift", ForceSensorDrift(rate=0.01))
GROWS = Candidate("pressure_friction", PressureFriction())
OFFSET = Candidate("valve_offset", ValveOffset(offset=5e3))
READS_MORE = Candidate("pressure_sensor_gain", PressureSensorGain(error=0.02))
GIVES_MORE = Candidate("valve_gain", ValveGain(error=0.02))
READS_LESS = Candidate("force_sensor_gain", ForceSensorGain(error=-0.02))
RUB = Candidate("coulomb_friction", CoulombFriction(magnitude=20.0))
THRESHOLD = Candidate("threshold_pressure", ThresholdPressure(pressure=20e3))


def _fits(told: Recording, *candidates: Candidate) -> tuple[Problem, list[Rival]]:
    """The model alone, with one effect more, and so on."""
    problem = problem_of(told, MODEL, {})
    sets = (candidates[:count] for count in range(len(candidates) + 1))
    return problem, [fitted(problem, *one) for one in sets]


def _stretches_and_rubs(newtons: float) -> Hidden:
    """60 kPa that do not pull, about 75 N, and so much dry friction."""
    return lambda moment: threshold(60.0)(moment) + rubbing(newtons)(moment)


@pytest.mark.parametrize(("newtons", "seen"), [(2.5, False), (8.0, True)])
def test_an_effect_that_changes_no_reading_is_not_worth_its_price(
    newtons: float, *, seen: bool
) -> None:
    # Full scale is 1.3 kN, of which sensors drift 3 N; these are quiet.
    told = recording(_stretches_and_rubs(newtons), noise=0.1)
    problem, (null, best, larger) = _fits(told, THRESHOLD, RUB)
    assert larger.evidence - best.evidence > 100.0
    assert worth(problem, null, best, larger, 20.0) is seen
    # So is a first one.
    problem, (null, best) = _fits(recording(rubbing(newtons), noise=0.1), RUB)
    assert best.evidence - null.evidence > 100.0
    assert worth(problem, null, null, best, 20.0) is seen


@pytest.mark.parametrize(
    ("hidden", "candidate", "seen"),
    [
        pytest.param(rubbing(2.5), RUB, False, id="5 N from there to back"),
        pytest.param(rubbing(4.0), RUB, True, id="8 N from there to back"),
        pytest.param(lambda m: 4.0 + 0 * m.time, BIAS, False, id="4 N all the way"),
        pytest.param(lambda m: 8.0 + 0 * m.time, BIAS, True, id="8 N all the way"),
    ],
)
def test_a_first_changes_a_reading_by_what_it_takes_and_what_it_adds(
    hidden: Hidden, candidate: Candidate, *, seen: bool
) -> None:
    """By 0.5 % of 1.3 kN at least, which is 6.5 N."""
    problem = pinned(problem_of(recording(hidden, noise=0.1), MODEL, {}))
    null, best = (fitted(problem, *one) for one in ((), (candidate,)))
    assert best.evidence - null.evidence > 100.0
    assert worth(problem, null, null, best, 20.0) is seen


@pytest.mark.parametrize(("first", "seen"), [(GIVES_MORE, True), (RUB, False)])
def test_the_first_that_acts_somewhere_is_as_visible_as_it_is_by_itself(
    first: Candidate, *, seen: bool
) -> None:
    """Of 12 N constants take all but 2; beside friction these may mend its form."""
    told = recording(lambda m: 12.0 + rubbing(12.0)(m) * (first is RUB), noise=0.1)
    if first is GIVES_MORE:
        told = altered(told, moments(), "current", lambda c: 0.004 + (c - 0.004) / 1.05)
    problem, (null, best, larger) = _fits(told, first, BIAS)
    assert larger.evidence - best.evidence > 100.0
    assert worth(problem, null, best, larger, 20.0) is seen


@pytest.mark.parametrize(("weaker", "seen"), [(0.021, True), (0.003, False)])
def test_two_that_one_other_imitates_are_each_held_against_the_readings(
    weaker: float, *, seen: bool
) -> None:
    """A regulator gives 2.3 % more and a cell reads 2.1 % less than it should.

    A pressure that reads 2.2 % too much does the same to 0.1 % of full scale.
    """
    told = altered(
        recording(lambda m: -weaker * textbook(m), noise=0.1), moments(), "current",
        lambda current: 0.004 + (current - 0.004) / (1.002 + weaker),
    )  # fmt: skip
    problem = pinned(problem_of(told, MODEL, {}))
    null, best, larger = (
        fitted(problem, *one) for one in ((), (READS_MORE,), (GIVES_MORE, READS_LESS))
    )
    assert larger.evidence - best.evidence > LEAST_MORE
    assert worth(problem, null, best, larger, 20.0) is seen


@pytest.mark.parametrize(("newtons", "worth_it"), [(10.0, False), (20.0, True)])
def test_a_ramp_that_a_sound_sensor_may_drift_is_no_fault(
    newtons: float, *, worth_it: bool
) -> None:
    # Sensors drift by 0.2 % (sd) of 1.3 kN; a ramp of that sd ends 9 N away.
    told = recording(lambda m: newtons * m.time / 690.0, noise=0.1)
    problem, (null, best) = _fits(told, DRIFT)
    assert best.evidence - null.evidence > 100.0
    assert worth(problem, null, null, best, 20.0) is worth_it


def _drifts(force: Array) -> Array:
    return force + np.linspace(0.0, 40.0, force.size)


def test_a_drift_that_shows_in_the_grip_alone_is_held_against_the_grip() -> None:
    told = with_grip(recording(noise=0.1))
    told = altered(
        told, moments(), "force", lambda read: read + np.linspace(0, 40, read.size)
    )
    problem = problem_of(without(told, "pressure", "current"), JAWED, {})
    assert problem.signals == (Signal.GRIP,)
    null, best = (fitted(problem, *one) for one in ((), (DRIFT,)))
    assert best.evidence - null.evidence > 20.0
    assert worth(problem, null, null, best, 20.0)


@pytest.mark.parametrize(
    ("hidden", "first", "further", "worth_it"),
    [
        (_stretches_and_rubs(7.0), THRESHOLD, RUB, True),
        (rubbing_more(0.3), RUB, GROWS, False),
    ],
)
def test_what_closes_little_must_not_be_what_bends_the_first(
    hidden: Hidden, first: Candidate, further: Candidate, *, worth_it: bool
) -> None:
    """Each closes about a hundredth of the first gap, far above the noise."""
    problem, (null, best, larger) = _fits(recording(hidden), first, further)
    assert larger.evidence - best.evidence > 100.0
    assert best.fit.cost - larger.fit.cost < 0.015 * (null.fit.cost - best.fit.cost)
    assert larger.excess < (2 * larger.fit.samples) ** 0.5
    assert worth(problem, null, best, larger, 20.0) is worth_it


def test_what_but_bends_the_first_may_close_as_much_as_it_will() -> None:
    problem, (null, best, larger) = _fits(recording(rubbing_more(6.0)), RUB, GROWS)
    closed = null.fit.cost - larger.fit.cost
    assert best.fit.cost - larger.fit.cost > 0.06 * closed
    assert not worth(problem, null, best, larger, 20.0)


@pytest.mark.parametrize(
    ("first", "further", "worth_it"),
    [
        ((), (), True),
        (("coulomb_friction",), (), False),
        ((), ("threshold_pressure",), False),
    ],
)
def test_of_what_a_known_double_closes_bending_the_first_may_not_take_most(
    monkeypatch: pytest.MonkeyPatch,
    first: tuple[str, ...],
    further: tuple[str, ...],
    *,
    worth_it: bool,
) -> None:
    problem, (null, best, larger) = _fits(
        recording(_stretches_and_rubs(40.0)), THRESHOLD, RUB
    )
    closed = null.fit.cost - larger.fit.cost
    assert best.fit.cost - larger.fit.cost > 0.06 * closed
    monkeypatch.setattr(price, "bent", lambda _, rival, names: 0.4 * rival.fit.cost)
    monkeypatch.setattr(ThresholdPressure, "confused_with", first)
    monkeypatch.setattr(CoulombFriction, "confused_with", further)
    assert worth(problem, null, best, larger, 20.0) is worth_it


@pytest.mark.parametrize(
    ("left", "share", "worth_it"),
    [(0.5, 0.3, True), (0.01, 0.3, False), (-0.5, 0.3, False), (-0.5, 0.4, True)],
)
def test_what_leaves_noise_where_bending_leaves_more_need_not_keep_a_third(
    monkeypatch: pytest.MonkeyPatch, left: float, share: float, *, worth_it: bool
) -> None:
    """An addition that closes little takes all there is above the noise.

    Where bending leaves three tenths of its gain, that is believed if bending the first
    alone leaves more than noise, by half the samples; not if it leaves noise too.
    """
    problem, (null, best, larger) = _fits(
        recording(_stretches_and_rubs(7.0)), THRESHOLD, RUB
    )
    samples, further = larger.fit.samples, best.fit.cost - larger.fit.cost
    assert further < 0.06 * (null.fit.cost - larger.fit.cost)
    assert larger.fit.cost < samples + (2 * samples) ** 0.5
    assert share * further > 100.0
    unbent = {1: (1 + left) * samples, 2: (1 + left) * samples - share * further}
    monkeypatch.setattr(price, "bent", lambda _, rival, __: unbent[len(rival.names)])
    if left > 0.1:
        unbent[2] = samples
    assert worth(problem, null, best, larger, 20.0) is worth_it


@pytest.mark.parametrize(
    ("kept", "share", "worth_it"),
    [(120.0, 0.7, True), (80.0, 0.7, False), (80.0, 0.9, True), (40.0, 0.9, False)],
)
def test_of_a_small_gain_bending_the_first_must_leave_nearly_all(
    monkeypatch: pytest.MonkeyPatch, kept: float, share: float, *, worth_it: bool
) -> None:
    problem, (null, best, larger) = _fits(
        recording(_stretches_and_rubs(7.0)), THRESHOLD, RUB
    )
    left = {1: kept, 2: 0.0}
    monkeypatch.setattr(price, "bent", lambda _, rival, __: left[len(rival.names)])
    nearer = replace(best, fit=replace(best.fit, cost=larger.fit.cost + kept / share))
    assert worth(problem, null, nearer, larger, 20.0) is worth_it


@pytest.mark.parametrize(
    ("left", "share", "worth_it"),
    [(1.05, 0.9, True), (1.05, 0.7, False), (1.15, 0.9, False)],
)
def test_what_no_bending_takes_need_leave_but_nearly_noise(
    monkeypatch: pytest.MonkeyPatch, left: float, share: float, *, worth_it: bool
) -> None:
    problem, (null, best, larger) = _fits(
        recording(_stretches_and_rubs(7.0)), THRESHOLD, RUB
    )
    cost, further = left * larger.fit.samples, best.fit.cost - larger.fit.cost
    assert further < 0.06 * (null.fit.cost - larger.fit.cost)
    best, larger = (
        replace(one, fit=replace(one.fit, cost=own))
        for one, own in ((best, cost + further), (larger, cost))
    )
    bare = {1: cost + share * further, 2: cost}
    monkeypatch.setattr(price, "bent", lambda _, rival, __: bare[len(rival.names)])
    assert worth(problem, null, best, larger, 20.0) is worth_it


@pytest.mark.parametrize(
    ("further", "worth_it"), [(OFFSET, True), (RUB, False)], ids=["valve", "muscle"]
)
def test_what_gains_where_nothing_bends_need_not_outdo_a_bend(
    monkeypatch: pytest.MonkeyPatch, further: Candidate, *, worth_it: bool
) -> None:
    """A threshold bends in the force alone, which an offset of the valve leaves be."""
    told = altered(
        recording(_stretches_and_rubs(20.0)), moments(), "current", lambda i: i - 2.5e-4
    )
    monkeypatch.setattr(price, "LEAST_OWN", np.inf)
    monkeypatch.setattr(price, "UNBENT", np.inf)
    problem, (null, best, larger) = _fits(told, THRESHOLD, further)
    assert larger.evidence - best.evidence > 100.0
    assert worth(problem, null, best, larger, 20.0) is worth_it


@pytest.mark.parametrize(("newtons", "worth_it"), [(7.0, False), (24.0, True)])
def test_what_leaves_more_than_noise_must_close_more(
    newtons: float, *, worth_it: bool
) -> None:
    told = recording(restless(_stretches_and_rubs(newtons)))
    problem, (null, best, larger) = _fits(told, THRESHOLD, RUB)
    assert larger.evidence - best.evidence > 40.0
    assert larger.excess > 10 * (2 * larger.fit.samples) ** 0.5
    assert worth(problem, null, best, larger, 20.0) is worth_it


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
    null, best, larger = (fitted(problem, *one) for one in ((), (RUB,), (RUB, BIAS)))
    assert larger.evidence - best.evidence > 30.0
    assert worth(problem, null, best, larger, 20.0) is worth_it


@pytest.mark.parametrize(
    ("doubles", "kept", "worth_it"),
    [((), 0.3, True), (("coulomb_friction",), 0.3, False),
     (("coulomb_friction",), 0.5, True)],
)  # fmt: skip
def test_far_above_the_noise_bending_its_double_must_leave_much_of_what_was_left(
    monkeypatch: pytest.MonkeyPatch,
    doubles: tuple[str, ...],
    kept: float,
    *,
    worth_it: bool,
) -> None:
    """A friction closes little beside a threshold, but most of what that left."""
    problem = problem_of(recording(_stretches_and_rubs(9.0)), MODEL, {})
    problem = louder(problem, {Signal.FORCE: 1.4, Signal.PRESSURE: 1.0})
    null, best, larger = (
        fitted(problem, *one) for one in ((), (THRESHOLD,), (THRESHOLD, RUB))
    )
    further = best.fit.cost - larger.fit.cost
    assert further < 0.06 * (null.fit.cost - larger.fit.cost)
    left = best.fit.misfits[Signal.FORCE]
    assert further > 0.5 * left
    bare = {1: kept * left, 2: 0.0}
    monkeypatch.setattr(price, "bent", lambda _, rival, __: bare[len(rival.names)])
    monkeypatch.setattr(ThresholdPressure, "confused_with", doubles)
    assert worth(problem, null, best, larger, 20.0) is worth_it


def _off_by(zero: float) -> Callable[[Array], Array]:
    return lambda reading: reading + zero
