from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.conclude import Conclusion, Verdict, conclude
from gripperd.diagnose.diagnosis import Diagnosis, diagnose
from gripperd.diagnose.rivalry import Contest
from gripperd.model.track import Array
from tests.diagnose.small import MODEL, Moment, nothing, recording


def _judged(told: Diagnosis, contest: Contest) -> Conclusion:
    return conclude(told.split.train, told.found, contest)


def test_what_explains_all_and_has_no_rival_is_named(told: Diagnosis) -> None:
    concluded = _judged(told, replace(told.contest, rivals=((),)))
    assert concluded.verdict is Verdict.NAMED
    assert concluded.share > 0.9


def test_with_an_equal_rival_it_is_ambiguous(told: Diagnosis) -> None:
    twin = told.contest.best
    concluded = _judged(told, replace(told.contest, rivals=((twin,),)))
    assert concluded.verdict is Verdict.AMBIGUOUS


def test_structure_that_nothing_explains_is_unexplained(told: Diagnosis) -> None:
    concluded = _judged(told, Contest(told.found.null, (), ()))
    assert concluded.verdict is Verdict.UNEXPLAINED
    assert concluded.share == pytest.approx(0.0, abs=0.05)


def test_noise_alone_is_none() -> None:
    told = diagnose(recording(nothing), MODEL, {}, {})
    assert told.verdict is Verdict.NONE


def _bump(moment: Moment) -> Array:
    """Nothing that a library holds: 60 N at one length and pressure."""
    length = (moment.contraction - 0.1) / 0.05
    pressure = (moment.pressure - 250e3) / 100e3
    return np.asarray(60.0 * np.exp(-(length**2) - pressure**2))


def test_a_poor_explanation_is_no_explanation() -> None:
    told = diagnose(recording(_bump), MODEL, {}, {})
    assert told.verdict is Verdict.UNEXPLAINED
    assert told.conclusion.share < 0.5
