from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.fit.polish import polished
from gripperd.diagnose.search import overstepped
from gripperd.diagnose.search.found import Found
from gripperd.diagnose.search.overstepped import with_overstepped
from gripperd.diagnose.search.rivalry import Contest, contest
from gripperd.diagnose.search.stepwise import search
from gripperd.diagnose.setup import problem_of
from gripperd.effects.threshold_pressure import ThresholdPressure
from tests.diagnose.small import MODEL, Hidden, pinned, recording, restless, threshold

OPEN = ("muscle.diameter", "muscle.braid_angle")
TOLERANCES = {"muscle.diameter": 1e-4, "muscle.braid_angle": 1.7e-3}
BORE = "parameter:muscle.diameter"
LISTED = (
    Candidate("threshold_pressure", ThresholdPressure(pressure=20e3)),
    Candidate(BORE, None, 0),
    Candidate("parameter:muscle.braid_angle", None, 1),
)


def _told(diameter: float, hidden: Hidden) -> tuple[Found, Contest]:
    built = replace(MODEL, muscle=replace(MODEL.muscle, diameter=diameter))
    problem = pinned(problem_of(recording(hidden), built, TOLERANCES), *OPEN)
    found = search(problem, LISTED[:1], np.random.default_rng(0))
    return found, contest(found, LISTED[:1])


def test_a_bore_that_its_tolerance_holds_back_is_told() -> None:
    found, best = _told(0.0208, restless(threshold(60.0)))
    assert found.problem.is_inflated
    assert best.best.names == ("threshold_pressure",)
    told = with_overstepped(found, best, LISTED)
    assert told.best.names == ("threshold_pressure", BORE)
    # Built 20 mm, said to be 20.8 mm known to 0.1 mm.
    shift = float(told.best.fit.point.shifts[0])
    assert shift == pytest.approx(-8.0, abs=2.0)
    # Without the threshold the bore alone has to make do, and is fitted anew for it.
    assert [one.without.names for one in told.places] == [
        (BORE,),
        ("threshold_pressure",),
    ]
    bare = polished(found.problem, told.places[0].without.fit.point)
    assert told.places[0].without.fit.cost == pytest.approx(bare.cost, rel=1e-3)


def test_a_bore_within_its_tolerance_is_not_told() -> None:
    found, best = _told(0.0201, restless(threshold(60.0)))
    assert found.problem.is_inflated
    assert with_overstepped(found, best, LISTED) is best


def test_near_the_noise_nothing_is_let_go() -> None:
    found, best = _told(0.0208, threshold(60.0))
    calm = replace(found, problem=replace(found.problem, inflations={}))
    assert with_overstepped(calm, best, LISTED) is best


def test_a_size_that_nobody_mistakes_so_far_is_not_told(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    found, best = _told(0.0208, restless(threshold(60.0)))
    # Were a muscle of 20 mm never taken for one of 20.8 mm.
    monkeypatch.setattr(overstepped, "FAR", {"muscle.diameter": 0.03})
    assert BORE not in with_overstepped(found, best, LISTED).best.names


def test_what_was_taken_for_another_size_in_earnest_may_be_told() -> None:
    # A braid of 12 mm for a bore of 10 mm; 296 mm for 300 mm between other ends.
    assert 0.2 < overstepped.FAR["muscle.diameter"] < 0.3
    assert 4 / 300 < overstepped.FAR["muscle.rest_length"] < 0.1
