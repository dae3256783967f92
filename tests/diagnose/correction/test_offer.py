from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from gripperd.config import load_model
from gripperd.diagnose.correction.offer import Offer, offers
from gripperd.diagnose.fit.polish import polished
from gripperd.diagnose.readings.columns import BY_QUANTITY
from gripperd.diagnose.residuals.holdout import Split, split
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.setup import problem_of
from gripperd.diagnose.verdict.initial_state import with_usual_state
from gripperd.effects.threshold_pressure import ThresholdPressure
from gripperd.model.effect import Signal
from gripperd.model.track import Array
from gripperd.recordings import read_recording
from tests.diagnose.offered import bump as by_hand
from tests.diagnose.small import (
    MODEL,
    Hidden,
    Moment,
    altered,
    nothing,
    pinned,
    recording,
    threshold,
)
from tests.hidden_rig import make_case

PEAK, LENGTH, PRESSURE = 60.0, 0.05, 100e3
WAVE = 0.2 / 3


def _bump(moment: Moment) -> Array:
    """Nothing that a library holds: 60 N at one length and pressure."""
    return _bump_at(moment.pressure, moment.contraction)


def _bump_at(pressure: Array, contraction: Array) -> Array:
    length, load = (contraction - 0.1) / LENGTH, (pressure - 250e3) / PRESSURE
    return np.asarray(PEAK * np.exp(-(length**2) - load**2))


def _ripple(moment: Moment) -> Array:
    """Three waves along the stroke: strands that slip one over the other."""
    return np.asarray(30.0 * np.sin(2 * np.pi * moment.contraction / WAVE))


def _offered(problem: Problem) -> list[Offer]:
    parts = split(problem)
    base = _base(parts)
    return list(offers(parts, [Signal.FORCE], base, base))


def _base(parts: Split) -> Point:
    start = Point(np.zeros(len(parts.train.constants)))
    return with_usual_state(parts.train, polished(parts.train, start).point)


def _small(hidden: Hidden) -> Problem:
    return pinned(problem_of(recording(hidden), MODEL, {}), "muscle.diameter")


def _rig(folder: Path) -> Problem:
    """As other hands simulate it, with nothing hidden."""
    case = make_case(folder, seed=7, family="A", kind="none")
    file = load_model(case.model)
    told = read_recording(case.recording)
    return problem_of(told, file.explanation(), file.tolerances)


@pytest.fixture(scope="module")
def bump() -> Offer:
    (offer,) = _offered(_small(_bump))
    return offer


@pytest.fixture(scope="module")
def ripple() -> list[Offer]:
    return _offered(_small(_ripple))


def _inputs(offer: Offer, pressure: float, contraction: float) -> Array:
    """The regressors at one place, everything else as usual."""
    found = offer.correction
    places = {"pressure": pressure, "contraction": contraction}
    row = [
        places.get(one.quantity, usual)
        for one, usual in zip(found.regressors, found.usual.tolist(), strict=True)
    ]
    return np.array([row])


def test_it_gives_what_the_model_lacks(bump: Offer) -> None:
    assert bump.correction.signal is Signal.FORCE
    # On the isobars of 200 and 300 kPa and on the isometric sweep at 0.08.
    for pressure, contraction in ((200e3, 0.1), (300e3, 0.15), (120e3, 0.08)):
        given = bump.correction.at(_inputs(bump, pressure, contraction))
        expected = _bump_at(np.array([pressure]), np.array([contraction]))
        assert given == pytest.approx(expected, abs=8.0)


def test_sweeps_sampled_at_rates_of_their_own_are_learnt_from_together() -> None:
    hasty = altered(
        recording(_bump), ("b", "d", "e"), "time", lambda t: t[0] + (t - t[0]) / 5
    )
    problem = pinned(problem_of(hasty, MODEL, {}), "muscle.diameter")
    loud = replace(problem.noises[Signal.FORCE], correlation=0.6)
    problem = replace(problem, noises={Signal.FORCE: loud})
    (offer,) = _offered(problem)
    given = offer.correction.at(_inputs(offer, 200e3, 0.1))
    expected = _bump_at(np.array([200e3]), np.array([0.1]))
    assert given == pytest.approx(expected, abs=8.0)


def test_what_did_not_vary_is_held_where_it_was() -> None:
    told = recording(_bump)
    warm = replace(
        told,
        runs=tuple(
            replace(
                run,
                columns={**run.columns, "temperature": 0 * run.columns["time"] + 295},
            )
            for run in told.runs
        ),
    )
    (offer,) = _offered(pinned(problem_of(warm, MODEL, {}), "muscle.diameter"))
    assert offer.correction.held == {BY_QUANTITY["temperature"]: (295.0, 295.0)}


def test_it_is_worth_what_it_takes_off_on_sweeps_left_out(bump: Offer) -> None:
    worth = bump.worth
    taken = worth.without**2 - worth.corrected**2
    assert worth.gain == pytest.approx(taken)
    assert worth.gain > worth.std > 0.0
    # One of the two sweeps left out runs off into a corner that no other covers.
    assert 0.5 < worth.inside < 1.0


@pytest.mark.parametrize(
    ("pressure", "contraction"),
    [
        pytest.param(650e3, 0.08, id="higher pressure"),
        pytest.param(300e3, 0.3, id="further contraction"),
        pytest.param(500e3, 0.19, id="a corner between the sweeps"),
    ],
)
def test_outside_its_fence_it_gives_nothing(
    bump: Offer, pressure: float, contraction: float
) -> None:
    assert np.isnan(bump.correction.at(_inputs(bump, pressure, contraction))).all()


def test_nor_does_it_where_a_quantity_that_does_not_matter_was_never_seen() -> None:
    found = by_hand().correction
    assert np.isfinite(found.at(np.array([[200e3, 0.15]]))).all()
    assert np.isnan(found.at(np.array([[200e3, 0.25]]))).all()


def test_what_an_effect_explains_as_well_needs_no_correction() -> None:
    parts = split(_small(threshold(25.0)))
    base = _base(parts)
    built = Point(np.zeros(len(parts.train.constants)))
    known = built.with_effect(ThresholdPressure(pressure=25e3))
    (offer,) = offers(parts, [Signal.FORCE], base, base)
    assert offer.worth.corrected < 0.7 * offer.worth.without
    assert not list(offers(parts, [Signal.FORCE], base, known))


def test_a_sweep_that_does_not_repeat_is_no_correction() -> None:
    parts = split(_small(_bump))
    base = _base(parts)
    usual = split(_small(nothing)).test
    elsewhere = replace(parts, test=replace(usual, constants=parts.test.constants))
    assert not list(offers(elsewhere, [Signal.FORCE], base, base))


def test_where_nothing_is_missing_nothing_is_offered() -> None:
    assert _offered(_small(nothing)) == []


def test_the_same_recording_gives_the_same_correction(bump: Offer) -> None:
    (again,) = _offered(_small(_bump))
    place = _inputs(bump, 200e3, 0.1)
    assert again.correction.at(place) == bump.correction.at(place)


def test_a_ripple_of_the_braid_comes_down_to_the_noise(ripple: list[Offer]) -> None:
    (offer,) = ripple
    assert offer.worth.without > 18.0
    # The rig's noise is 3 N.
    assert offer.worth.corrected < 5.0


def test_its_length_is_that_of_the_ripple(ripple: list[Offer]) -> None:
    (offer,) = ripple
    found = offer.correction
    lengths = dict(
        zip((one.name for one in found.regressors), found.lengths, strict=True)
    )
    # A wave turns within a quarter of its period.
    assert lengths["contraction"] == pytest.approx(WAVE / 4, rel=0.4)
    assert lengths["direction"] is None


def test_a_rig_that_hides_nothing_gets_next_to_nothing(tmp_path: Path) -> None:
    for offer in _offered(_rig(tmp_path)):
        assert offer.worth.corrected > 0.98 * offer.worth.without
