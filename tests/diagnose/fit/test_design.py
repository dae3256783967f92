from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.fit.candidates import WRONG, Candidate, candidates, forms
from gripperd.diagnose.fit.design import Design, Member, design, limits, problem_prior
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.residuals.response import responses
from gripperd.diagnose.setup import problem_of
from gripperd.effects import EFFECTS
from gripperd.effects.ambient_pressure import AmbientPressure
from gripperd.effects.channel_delay import ChannelDelay
from gripperd.effects.coulomb_friction import CoulombFriction
from gripperd.effects.force_sensor_bias import ForceSensorBias
from gripperd.effects.length_datum import LengthDatum
from gripperd.effects.pressure_sensor_bias import PressureSensorBias
from gripperd.effects.viscous_friction import ViscousFriction
from gripperd.model.effect import Signal
from tests.diagnose.small import (
    LINKAGE,
    MODEL,
    altered,
    covariance,
    nothing,
    recording,
    rubbing,
    undoubted,
    with_grip,
    without,
)

COLUMNS = frozenset({"time", "current", "pressure", "contraction", "force"})
BIAS = Candidate("force_sensor_bias", ForceSensorBias(bias=5.0))
RUB = Candidate("coulomb_friction", CoulombFriction(magnitude=20.0))


@pytest.fixture
def start(blank: Problem) -> Point:
    return Point(np.zeros(len(blank.constants)))


def _only(found: Design) -> Member:
    (member,) = found.members
    return member


def _prior(problem: Problem, point: Point, candidate: Candidate) -> float:
    assert candidate.effect is not None
    (response,) = responses(problem, point, candidate.effect)
    prior = problem_prior(problem, candidate.effect, response)
    assert prior is not None
    return prior


def test_products_are_those_of_the_covariance_of_the_noise(
    blank: Problem, start: Point
) -> None:
    blank = undoubted(blank)
    found = design(blank, start, [BIAS])
    member = _only(found)
    scale = 5.0 * _prior(blank, start, BIAS)
    products = found.gram.products[np.ix_(member.columns, member.columns)]
    moments = found.gram.moments[member.columns]
    law = blank.noises[Signal.FORCE]
    expected, moment = 0.0, 0.0
    for block, time, left in zip(
        blank.blocks, blank.times, blank.residuals(start), strict=True
    ):
        if block.signal is Signal.FORCE:
            column = np.full(time.size, scale)
            seen = np.linalg.solve(covariance(time, law), column)
            expected += float(seen @ column)
            moment += float(seen @ left)
    assert products.item() == pytest.approx(expected, rel=1e-3)
    assert moments.item() == pytest.approx(moment, rel=1e-3)


def test_one_prior_sigma_is_a_few_per_cent_of_full_scale(
    blank: Problem, start: Point
) -> None:
    for candidate in (BIAS, RUB):
        assert candidate.effect is not None
        (response,) = responses(blank, start, candidate.effect)
        prior = _prior(blank, start, candidate)
        force = np.concatenate(
            [
                piece
                for block, piece in zip(blank.blocks, response, strict=True)
                if block.signal is Signal.FORCE
            ]
        )
        size = prior * np.sqrt(np.mean(force**2)) / blank.full_scale[Signal.FORCE]
        assert 0.01 < size < 0.1


def test_a_sensor_is_wrong_by_a_share_of_its_own_scale() -> None:
    """A spring that leaves little of the pull makes any error loud in the grip."""
    linkage = replace(LINKAGE, spring_preload=1000.0)
    told = with_grip(recording(), preload=1000.0)
    problem = problem_of(told, replace(MODEL, linkage=linkage), {})
    assert problem.full_scale[Signal.GRIP] < 0.2 * problem.full_scale[Signal.FORCE]
    assert BIAS.effect is not None
    start = Point(np.zeros(len(problem.constants)))
    (response,) = responses(problem, start, BIAS.effect)
    prior = _prior(problem, start, BIAS)
    place = next(i for i, b in enumerate(problem.blocks) if b.signal is Signal.FORCE)
    size = prior * float(np.max(response[place]))
    assert size == pytest.approx(0.04 * problem.full_scale[Signal.FORCE])


def test_what_leaves_no_trace_is_faint(blank: Problem, start: Point) -> None:
    jaws = [
        Candidate("jaw_compliance", one) for one in forms(EFFECTS["jaw_compliance"])
    ]
    found = design(blank, start, [*jaws, BIAS])
    assert found.faint == ("jaw_compliance",)
    assert _only(found).candidate is BIAS


def test_a_name_with_one_visible_form_is_not_faint(
    blank: Problem, start: Point
) -> None:
    unmoved = Candidate("coulomb_friction", ForceSensorBias(bias=5.0))
    assert design(blank, start, [RUB, unmoved]).faint == ()


def test_an_amplitude_that_cannot_be_negative_is_bounded(
    blank: Problem, start: Point
) -> None:
    low = {one.name: design(blank, start, [one]).gram.low[-1] for one in (BIAS, RUB)}
    assert low["coulomb_friction"] == 0.0
    assert low["force_sensor_bias"] < -1.0


def test_a_constant_stays_within_its_tolerance(blank: Problem, start: Point) -> None:
    found = design(blank, start, [])
    high, low = found.gram.high[found.nuisance], found.gram.low[found.nuisance]
    assert found.nuisance.size == len(blank.constants)
    assert (high < 4).all()
    # But a valve that follows at once, by nominal 20 ms of 20, follows no sooner.
    at_once = np.array([one.path == "response.valve" for one in blank.constants])
    np.testing.assert_array_equal(low, np.where(at_once, -1.0, -high))


def test_every_amplitude_has_a_column(blank: Problem, start: Point) -> None:
    rates = Candidate("viscous_friction", ViscousFriction())
    assert _only(design(blank, start, [rates])).columns.size == 3


@pytest.mark.parametrize("size", [12.0, 0.0])
def test_what_acts_already_is_still_fitted(size: float) -> None:
    problem = problem_of(recording(rubbing(size)), MODEL, {})
    start = Point(np.zeros(len(problem.constants)))
    rub = CoulombFriction(magnitude=12.0)
    there = start.with_effect(rub)
    prior = _prior(problem, there, Candidate(rub.name, rub))
    found = design(problem, there, [BIAS])
    (acting,) = found.acting
    fit = found.fit()
    place = fit.columns.tolist().index(int(acting.columns[0]))
    magnitude = fit.coefficients[place] * prior * 20.0
    assert magnitude == pytest.approx(size, abs=2.0)


def test_two_processes_give_what_one_gives(blank: Problem, start: Point) -> None:
    listed, _ = candidates(EFFECTS, blank, COLUMNS)
    acting = start.with_effect(CoulombFriction(magnitude=10.0))
    one, two = (
        design(replace(blank, processes=count), acting, listed) for count in (1, 2)
    )
    np.testing.assert_array_equal(two.gram.products, one.gram.products)
    np.testing.assert_array_equal(two.gram.moments, one.gram.moments)
    assert [m.candidate for m in two.members] == [m.candidate for m in one.members]
    assert two.faint == one.faint


def test_what_acts_is_no_candidate(blank: Problem, start: Point) -> None:
    there = start.with_effect(CoulombFriction(magnitude=12.0))
    assert _only(design(blank, there, [BIAS, RUB])).candidate is BIAS


def test_a_constant_that_is_free_already_is_no_candidate(blank: Problem) -> None:
    listed, _ = candidates({}, blank, COLUMNS)
    index = listed[0].constant
    assert index is not None
    freed = Point(np.zeros(len(blank.constants)), freed=frozenset({index}))
    found = design(blank, freed, listed)
    names = {one.candidate.name for one in found.members}
    assert WRONG + blank.constants[index].path not in names
    assert len(names) == len(listed) - 1


def test_a_fit_of_what_is_hidden_beats_one_of_what_is_not() -> None:
    problem = problem_of(recording(rubbing(20.0)), MODEL, {})
    start = Point(np.zeros(len(problem.constants)))
    found = design(problem, start, [BIAS, RUB])
    evidence = {one.candidate.name: found.fit(one).evidence for one in found.members}
    assert evidence["coulomb_friction"] > evidence["force_sensor_bias"] + 20.0
    assert evidence["coulomb_friction"] > found.fit().evidence + 20.0


def test_a_wrong_zero_of_contraction_is_bounded_by_the_stroke(blank: Problem) -> None:
    # 6.5 % of a stroke of 25 %.
    low, high = limits(blank, LengthDatum(shift=0.003), "shift")
    assert (low, high) == pytest.approx((-0.01625, 0.01625))


def test_how_late_the_contraction_is_read_is_no_length(blank: Problem) -> None:
    late = ChannelDelay(delay=0.1, channel=Signal.CONTRACTION)
    assert limits(blank, late, "delay") == (0.0, 1.0)


def test_no_muscle_was_sucked_empty(blank: Problem) -> None:
    bias = PressureSensorBias(bias=5e3)
    low, high = limits(blank, bias, "bias")
    top = blank.highest[Signal.PRESSURE]
    # Its muscle is vented, where the transmitter reads next to nothing.
    assert abs(blank.lowest[Signal.PRESSURE]) < 0.005 * top
    assert 0.0 < high < 0.015 * top
    # 6.5 % of full scale.
    assert low == pytest.approx(-0.065 * top, rel=0.02)


def _shifted(kilopascals: float) -> Problem:
    """A problem with every pressure read so much too high."""
    plain = recording(nothing)
    names = [run.name for run in plain.runs]
    shifted = altered(plain, names, "pressure", lambda read: read + 1e3 * kilopascals)
    return problem_of(shifted, MODEL, {})


def test_the_weather_is_on_top_of_the_zero() -> None:
    # What its zero leaves of the error is not what is read of a vented muscle.
    low = _shifted(-4.0)
    assert limits(low, PressureSensorBias(bias=5e3), "bias")[1] < 2e3
    assert limits(low, AmbientPressure(share=1.0), "zero") == (-2e3, 2e3)


def test_a_pressure_that_nothing_explains_has_a_full_scale(blank: Problem) -> None:
    unasked = problem_of(without(recording(nothing), "current"), MODEL, {})
    assert Signal.PRESSURE not in unasked.full_scale
    for problem in (unasked, blank):
        low, _ = limits(problem, PressureSensorBias(bias=5e3), "bias")
        assert low == pytest.approx(-0.065 * 500e3, rel=0.02)


def test_a_muscle_that_is_never_vented_tells_nothing_of_the_zero() -> None:
    problem = _shifted(60.0)
    _, high = limits(problem, PressureSensorBias(bias=5e3), "bias")
    assert high == pytest.approx(0.065 * problem.full_scale[Signal.PRESSURE])
