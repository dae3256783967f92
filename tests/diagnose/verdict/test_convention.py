from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.diagnosis import diagnose
from gripperd.diagnose.residuals.explanation import AtRest, Explanation
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.setup import problem_of
from gripperd.diagnose.verdict.convention import with_conventions
from gripperd.effects import EFFECTS
from gripperd.effects.coulomb_friction import CoulombFriction
from gripperd.effects.threshold_pressure import ThresholdPressure
from gripperd.model.effect import Effect
from gripperd.model.track import Array
from tests.diagnose.small import MODEL, Moment, nothing, recording

RUBS, IS_SOFT = CoulombFriction(), ThresholdPressure()
BARE = replace(MODEL, effects=())
INFLATING = replace(BARE, at_rest=AtRest.INFLATING)


@pytest.fixture(scope="module")
def problem() -> Problem:
    """Nothing is missing, and nothing rubs."""
    return problem_of(recording(nothing), BARE, {})


def _told(problem: Problem, *acting: Effect) -> str:
    point = Point(np.zeros(len(problem.constants)), effects=acting)
    plain = recording(nothing)
    remarks = with_conventions(plain, problem, point).remarks
    assert remarks[: len(plain.remarks)] == plain.remarks
    return " ".join(remarks[len(plain.remarks) :])


@pytest.mark.parametrize(
    ("model", "said"),
    [
        pytest.param(BARE, "", id="as it came"),
        pytest.param(INFLATING, "turns with the pressure", id="turns"),
        pytest.param(
            replace(INFLATING, fading=6.4),
            "turns with the pressure, and fades, by e in 6.4 s",
            id="turns and fades",
        ),
        pytest.param(
            replace(BARE, fading=0.1), "fades, by e in 0.1 s", id="fades as it came"
        ),
        pytest.param(
            replace(BARE, at_rest=AtRest.YIELDING),
            "yields a while and turns with the pressure",
            id="yields",
        ),
        pytest.param(
            replace(INFLATING, winding=4e-4),
            "turns with what a frame yields, 0.04% either way",
            id="a frame yields",
        ),
    ],
)
def test_what_friction_does_at_rest_is_said(
    problem: Problem, model: Explanation, said: str
) -> None:
    whole = f"Where nothing travels, dry friction {said}." if said else ""
    assert _told(replace(problem, model=model), RUBS) == whole


@pytest.mark.parametrize("acting", [(), (IS_SOFT,)])
def test_nothing_is_said_of_friction_that_there_is_none_of(
    problem: Problem, acting: tuple[Effect, ...]
) -> None:
    assert _told(replace(problem, model=INFLATING), *acting) == ""


def test_what_a_regulator_does_out_of_line_is_said(problem: Problem) -> None:
    vented = "Asked for nothing, the regulator vents, whatever its line says."
    sleeps = "Within 12.5 kPa of its command the regulator sleeps."
    assert _told(replace(problem, model=replace(BARE, vents=0.0))) == vented
    assert _told(replace(problem, band=12.5e3)) == sleeps


def _turning(moment: Moment) -> Array:
    """Friction that is against the pressure where nothing travels: 25 N."""
    if np.ptp(moment.contraction) > 0:
        return -25.0 * moment.direction
    return np.where(np.gradient(moment.pressure) >= 0, -25.0, 25.0)


def test_a_whole_diagnosis_says_it() -> None:
    told = diagnose(recording(_turning), MODEL, {}, EFFECTS)
    assert told.verdict.establishes
    assert (
        "Where nothing travels, dry friction turns with the pressure."
        in told.recording.remarks
    )
