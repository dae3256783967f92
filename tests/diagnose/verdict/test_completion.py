from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
import pytest

from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.residuals.holdout import Split, split
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.found import Found
from gripperd.diagnose.search.rivalry import Contest, Place
from gripperd.diagnose.setup import problem_of
from gripperd.diagnose.verdict import completion
from gripperd.diagnose.verdict.completion import completed, remarked
from gripperd.diagnose.verdict.gap import Gap, gaps
from gripperd.effects.coulomb_friction import CoulombFriction
from gripperd.effects.force_sensor_bias import ForceSensorBias
from gripperd.effects.threshold_pressure import ThresholdPressure
from gripperd.model.effect import Signal
from gripperd.model.track import Array
from tests.diagnose.fitted import ended, fitted
from tests.diagnose.small import (
    MODEL,
    Hidden,
    Moment,
    recording,
    restless,
    rubbing,
    threshold,
)

THRESHOLD = Candidate("threshold_pressure", ThresholdPressure())
RUB = Candidate("coulomb_friction", CoulombFriction())
BIAS = Candidate("force_sensor_bias", ForceSensorBias())
LISTED = (THRESHOLD, RUB, BIAS)


def _with_threshold(hidden: Hidden, noise: float = 1.0) -> tuple[Split, Found, Contest]:
    """A search that ended with a threshold, which is there beside something else."""

    def both(moment: Moment) -> Array:
        return threshold(60.0)(moment) + hidden(moment)

    parts = split(problem_of(recording(both, noise=noise), MODEL, {}))
    best = fitted(parts.train, THRESHOLD)
    found = ended(parts.train, best, 20.0)
    return parts, found, Contest(best, (Place(found.null),))


def test_what_was_left_out_adds_what_is_missing() -> None:
    parts, found, best = _with_threshold(rubbing(12.0))
    more = completed(parts, parts.test, found, best, LISTED)
    assert more.best.names == ("threshold_pressure", "coulomb_friction")
    friction = more.best.fit.point.effects[-1]
    assert isinstance(friction, CoulombFriction)
    assert friction.magnitude == pytest.approx(12.0, abs=1.0)


@dataclass(frozen=True, slots=True)
class Twin(CoulombFriction):
    """The same formula by another name."""

    name: ClassVar[str] = "twin"

    @property
    def is_misnamed(self) -> bool:
        return False


@pytest.mark.parametrize("stranger", [CoulombFriction, Twin])
def test_what_bears_its_name_by_right_comes_first(
    monkeypatch: pytest.MonkeyPatch, stranger: type[CoulombFriction]
) -> None:
    monkeypatch.setattr(stranger, "is_misnamed", True)
    parts, found, best = _with_threshold(rubbing(12.0))
    both = (RUB, Candidate("twin", Twin()))
    (right,) = (one for one in both if type(one.effect) is not stranger)
    more = completed(parts, parts.test, found, best, (THRESHOLD, *both))
    assert more.best.names == ("threshold_pressure", right.name)


@pytest.mark.parametrize(("newtons", "noise"), [(0.0, 1.0), (12.0, 4.0), (4.5, 0.1)])
def test_what_hardly_shows_or_is_hardly_off_lacks_nothing(
    newtons: float, noise: float
) -> None:
    """Beside noise of 12 N sweeps are not far off, and less than 7 N sensors drift."""
    parts, found, best = _with_threshold(rubbing(newtons), noise)
    assert completed(parts, parts.test, found, best, LISTED) is best


def test_who_has_chosen_it_is_told() -> None:
    """The threshold is there before the sweeps that were left out have a say."""
    whole = recording(lambda at: threshold(60.0)(at) + rubbing(12.0)(at))
    parts, found, best = _with_threshold(rubbing(12.0))
    more = completed(parts, parts.test, found, best, LISTED)
    remark = "coulomb friction: chosen with the help of sweeps held out."
    assert remarked(whole, best, more).remarks == (*whole.remarks, remark)
    assert remarked(whole, more, more) is whole


def test_what_closes_but_a_part_of_it_is_not_added() -> None:
    parts, found, best = _with_threshold(restless(rubbing(12.0)))
    assert completed(parts, parts.test, found, best, LISTED) is best


def test_what_spoils_another_signal_is_not_added(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def spoilt(
        test: Problem,
        points: Sequence[Point],
        rng: np.random.Generator,
    ) -> dict[Signal, Gap]:
        found = gaps(test, points, rng)
        pressure = found[Signal.PRESSURE]
        worse = 3 * pressure.recalibrated
        return found | {Signal.PRESSURE: replace(pressure, ci95_after=(worse, worse))}

    parts, found, best = _with_threshold(rubbing(12.0))
    monkeypatch.setattr(completion, "gaps", spoilt)
    assert completed(parts, parts.test, found, best, LISTED) is best
