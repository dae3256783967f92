from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.fit.inflation import louder
from gripperd.diagnose.residuals.constants import RESTING
from gripperd.diagnose.residuals.holdout import split
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search import selection
from gripperd.diagnose.search.alike import with_rests_alike
from gripperd.diagnose.search.found import Found
from gripperd.diagnose.search.resting import DECIDED
from gripperd.diagnose.search.selection import selected
from gripperd.diagnose.search.stepwise import search
from gripperd.diagnose.setup import problem_of
from gripperd.effects.first_cycle import FirstCycle
from gripperd.model.effect import Signal
from gripperd.model.track import Array
from tests.diagnose.fitted import ended, fitted
from tests.diagnose.small import (
    MODEL,
    Hidden,
    Moment,
    nothing,
    pinned,
    recording,
    textbook,
)

FIRST = Candidate("first_cycle", FirstCycle(gain=0.05))


def _turned(fades: float) -> Hidden:
    """Friction of the first sweep pushes instead, less after each pascal of way."""

    def pushed(moment: Moment) -> Array:
        is_first = np.ptp(moment.pressure) > 0 and not moment.contraction.any()
        slides = replace(moment, direction=np.ones_like(moment.time))
        rests = replace(moment, direction=np.zeros_like(moment.time))
        way = np.cumsum(np.abs(np.diff(moment.pressure, prepend=moment.pressure[0])))
        push = 2 * (textbook(rests) - textbook(slides)) * np.exp(-fades * way)
        return push if is_first else nothing(moment)

    return pushed


def _problem(hidden: Hidden) -> Problem:
    problem = problem_of(recording(hidden), MODEL, {})
    rests = [one.path for one in problem.constants if one.path.startswith("rest.")]
    return pinned(problem, "zero.force", *rests)


def _searched(problem: Problem) -> Found:
    return search(problem, [FIRST], np.random.default_rng(0))


def test_a_first_inflation_is_not_hidden_by_a_sign_of_its_own() -> None:
    found = _searched(_problem(_turned(fades=1e-6)))
    assert found.best.names == ()
    told = with_rests_alike(found, _searched)
    assert told.best.names == ("first_cycle",)
    assert told.best.evidence > found.best.evidence + DECIDED


def test_a_sweep_that_rests_the_other_way_is_no_first_inflation() -> None:
    found = _searched(_problem(_turned(fades=0.0)))
    assert found.best.names == ()
    assert with_rests_alike(found, _searched) is found


def test_where_all_rest_alike_nothing_is_searched_again() -> None:
    problem = _problem(nothing)
    found = ended(problem, fitted(problem))
    assert with_rests_alike(found, _never) is found


def _never(_: Problem) -> Found:
    raise AssertionError


@pytest.mark.parametrize(("sign", "is_asked"), [(0.7, False), (0.9, True)])
def test_most_of_a_sign_of_its_own_is_the_other_way(
    sign: float, *, is_asked: bool
) -> None:
    """Where the others rest midway."""
    problem = _problem(nothing)
    here = fitted(problem)
    shifts = np.array(
        [sign / RESTING * (o.path == "rest.1") for o in problem.constants]
    )
    fit = replace(here.fit, point=replace(here.fit.point, shifts=shifts))
    found = ended(problem, replace(here, fit=fit))
    told = with_rests_alike(found, _ahead(found.best.evidence + 2 * DECIDED))
    assert (told is not found) is is_asked


@pytest.mark.parametrize(("lead", "is_taken"), [(0.1, True), (-0.1, False)])
def test_something_else_has_to_be_clearly_better(
    lead: float, *, is_taken: bool
) -> None:
    problem = _problem(_turned(fades=0.0))
    here = fitted(problem)
    found = ended(problem, here)
    told = with_rests_alike(found, _ahead(here.evidence + DECIDED + lead))
    assert (told is not found) is is_taken


def test_noise_as_loud_as_the_misfit_tells_nothing() -> None:
    problem = _problem(_turned(fades=0.0))
    loud = louder(problem, {Signal.FORCE: 3.0})
    here = fitted(problem)
    ahead = _ahead(here.evidence + 10 * DECIDED)
    found = ended(problem, here)
    assert with_rests_alike(found, ahead) is not found
    assert with_rests_alike(found, lambda _: ahead(loud)) is found
    found = ended(loud, fitted(loud))
    assert with_rests_alike(found, _never) is found


def _ahead(evidence: float) -> Callable[[Problem], Found]:
    """A search that ends with so much."""

    def searched(problem: Problem) -> Found:
        best = fitted(problem, FIRST)
        cost = best.fit.cost + 2 * (best.evidence - evidence)
        return ended(problem, replace(best, fit=replace(best.fit, cost=cost)))

    return searched


def test_what_is_left_out_is_held_against_the_same_signs() -> None:
    parts = split(_problem(_turned(fades=1e-6)))
    rng = np.random.default_rng(0)
    told = selected(parts, [FIRST], {}, rng, lambda *_: None)
    assert told.contest.best.names == ("first_cycle",)
    sigma = {one.path: one.sigma for one in told.parts.test.constants}
    assert told.parts.test.constants == told.parts.train.constants
    # Of all that rest but "c" is left out, and may rest as it likes.
    assert [path for path, one in sigma.items() if one == RESTING] == ["rest.4"]


@pytest.mark.parametrize(("fades", "times"), [(1e-6, 2), (0.0, 1)])
def test_what_is_found_so_is_held_against_other_signs_at_rest(
    monkeypatch: pytest.MonkeyPatch, fades: float, times: int
) -> None:
    """As a pull that tires, which signs of their own had stood in for."""
    asked: list[tuple[str, ...]] = []

    def beside(found: Found, *_: object) -> Found:
        asked.append(found.best.names)
        return found

    monkeypatch.setattr(selection, "with_sign_beside", beside)
    rng = np.random.default_rng(0)
    selected(split(_problem(_turned(fades))), [FIRST], {}, rng, lambda *_: None)
    assert asked == [(), ("first_cycle",)][:times]
