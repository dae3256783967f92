"""What friction that was found holds at rest, and by which law."""

from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.diagnosis import Diagnosis, diagnose
from gripperd.diagnose.statement import statement
from gripperd.effects import EFFECTS
from gripperd.effects.coulomb_friction import CoulombFriction
from gripperd.model import Direction, StaticMuscle
from gripperd.model.effect import Signal
from gripperd.model.track import Array
from tests.diagnose.small import FORCE_NOISE, MODEL, Hidden, Moment, recording

SLIDING = 60.0


def _stuck(static: float) -> Hidden:
    """Friction while it slides, and so many times that where it rests."""

    def held(moment: Moment) -> Array:
        times = 1.0 if np.ptp(moment.contraction) > 0 else static
        return -SLIDING * times * moment.direction

    return held


def _told(hidden: Hidden, *names: str) -> Diagnosis:
    library = {name: EFFECTS[name] for name in ("force_sensor_bias", *names)}
    return diagnose(recording(hidden), MODEL, {}, library)


@pytest.mark.parametrize(("static", "stiction"), [(1.0, 0.0), (1.25, 0.3)])
def test_friction_may_hold_what_rests_better_than_what_slides(
    static: float, stiction: float
) -> None:
    found = _told(_stuck(static), "coulomb_friction")
    assert [entry.name for entry in found.named] == ["coulomb_friction"]
    assert found.explained.stiction == stiction
    assert found.nominal.stiction == found.recalibrated.stiction == 0.0
    told = found.named[0].parameters["magnitude"]
    assert told.value == pytest.approx(SLIDING, abs=1.5)
    assert found.gaps[Signal.FORCE].after < 1.2 * FORCE_NOISE
    courses = found.split.train.courses
    signs = found.split.train.explanation(found.explained).rests
    held = [
        sign * (1 + stiction)
        for course, sign in signs.items()
        if courses[course].run in "abc"
    ]
    assert held == pytest.approx([static] * 3, abs=0.08)
    says = "what rests it holds up to 1.3 times as much here"
    (sure,) = found.named
    open_one = replace(sure, equivalents=("pressure_friction",))
    for entry in (sure, open_one):
        assert (says in statement(found, entry)) is (stiction > 0)


@pytest.mark.parametrize("static", [1.0, 1.25])
def test_a_law_that_goes_by_the_rate_is_not_told_where_none_is_needed(
    static: float,
) -> None:
    found = _told(_stuck(static), "coulomb_friction")
    (effect,) = found.explained.effects
    assert isinstance(effect, CoulombFriction)
    assert (effect.slip, effect.distance) == (0.0, 0.0)
    # So a prediction has it, be the muscle at rest or not.
    here = StaticMuscle(MODEL.muscle, (effect,)).force(3e5, 0.1, Direction.CONTRACTING)
    assert StaticMuscle(MODEL.muscle).force(3e5, 0.1) - here == pytest.approx(
        SLIDING, abs=1.5
    )


def test_what_is_no_friction_has_no_stiction() -> None:
    found = _told(lambda m: 60.0 + 0 * m.time, "coulomb_friction")
    assert [entry.name for entry in found.named] == ["force_sensor_bias"]
    assert found.explained.stiction == 0.0


def test_who_is_overtaken_at_rest_stands_in_for_nobody() -> None:
    found = _told(
        _stuck(1.25), "coulomb_friction", "presliding_hysteresis", "pressure_friction"
    )
    assert found.explained.stiction > 0
    (place,) = found.contest.places
    assert found.contest.best.names == ("coulomb_friction",)
    assert place.rivals == ()
