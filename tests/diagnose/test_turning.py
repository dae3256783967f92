"""Dry friction: over what way it turns round, and with what."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from gripperd.diagnose.diagnosis import diagnose
from gripperd.diagnose.readings.recording import Recording, Run
from gripperd.effects import EFFECTS
from gripperd.effects.coulomb_friction import CoulombFriction
from gripperd.effects.linkage_friction import LinkageFriction, Turning
from gripperd.model.effect import Signal
from gripperd.model.track import Array
from tests.diagnose.small import (
    LINKAGE,
    MODEL,
    Moment,
    altered,
    moments,
    recording,
    textbook,
    with_grip,
)

SIZE = 240
OVER = 3.5e-4
"""Contraction over which it turns round by all but 1/e. [-]"""
LOOPS = (0.0, 0.02), (60e3, 0.05), (150e3, 0.08), (300e3, 0.1), (450e3, 0.12)
"""Pressures and lengths around which the muscle goes to and fro. [Pa], [-]"""
JAWS = (
    "linkage_friction", "linkage_backlash", "jaw_compliance", "force_sensor_gain",
    "force_sensor_bias",
)  # fmt: skip


def test_a_short_way_in_which_friction_turns_is_told() -> None:
    names = ("coulomb_friction", "pressure_friction", "presliding_hysteresis")
    told = diagnose(_rubbing(), MODEL, {}, {name: EFFECTS[name] for name in names})
    assert [entry.name for entry in told.named] == ["coulomb_friction"]
    (friction,) = told.contest.best.fit.point.effects
    assert isinstance(friction, CoulombFriction)
    assert friction.distance == pytest.approx(OVER, rel=0.3)
    assert friction.magnitude == pytest.approx(30.0, rel=0.03)


def _rubbing() -> Recording:
    """30 N that a slack braid does not have, and a laser on the length."""
    there_back = np.interp(np.linspace(0, 4, SIZE), [0, 1, 3, 4], [0, 1, -1, 0])
    runs, start = [], 0.0
    for place, (pressure, length) in enumerate(LOOPS):
        random = np.random.default_rng([1, place])
        moment = Moment(
            time=np.linspace(start, start + 24.0, SIZE),
            pressure=np.full(SIZE, pressure),
            contraction=length + 0.006 * there_back,
            direction=_turned(0.006 * there_back),
        )
        rubs = 30.0 * np.tanh(pressure / 25e3) * moment.direction
        columns = {
            "time": moment.time,
            "pressure": moment.pressure + random.normal(0.0, 1e3, SIZE),
            "contraction": moment.contraction + random.normal(0.0, 3e-5, SIZE),
            "force": textbook(moment) - rubs + random.normal(0.0, 2.0, SIZE),
        }
        runs.append(Run(str(place), columns))
        start += 90.0
    return Recording("turning", "0" * 64, tuple(runs))


def _turned(way: Array) -> Array:
    """Sign of friction by Dahl's law of exponent 1, solved step by step."""
    found, sign = np.empty(way.size), 0.0
    for index, step in enumerate(np.diff(way, prepend=way[0])):
        ahead = np.sign(step)
        sign = ahead - (ahead - sign) * np.exp(-abs(step) / OVER)
        found[index] = sign
    return found


def test_joints_that_keep_the_sign_of_their_travel_are_told_by_it() -> None:
    """Squeezed and let go at one width, they rub as they closed all the while."""
    told = with_grip(recording())
    for name, moment in moments().items():
        kept = 1.0 - 0.08 * moment.direction
        told = altered(told, (name,), "grip", partial(np.multiply, kept))
    model = replace(MODEL, linkage=LINKAGE)
    library = {name: EFFECTS[name] for name in JAWS}
    found = diagnose(told, model, {}, library)
    assert [entry.name for entry in found.named] == ["linkage_friction"]
    (joints,) = found.explained.effects
    assert isinstance(joints, LinkageFriction)
    assert joints.by is Turning.TRAVEL
    assert joints.loss == pytest.approx(0.08, rel=0.05)
    gap = found.gaps[Signal.GRIP]
    assert gap.after < 1.05 * gap.noise_floor
