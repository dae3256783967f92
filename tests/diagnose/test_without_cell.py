"""A gripper on objects: its muscle has no length sensor, and mostly no cell."""

from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.diagnosis import Diagnosis, diagnose
from gripperd.diagnose.readings.recording import Recording, Run
from gripperd.diagnose.setup import problem_of
from gripperd.diagnose.verdict.conclude import Verdict
from gripperd.effects import EFFECTS
from gripperd.errors import InputError
from gripperd.model.effect import Signal
from gripperd.model.track import Array
from gripperd.units import KILO, MILLI
from tests.diagnose.small import (
    FORCE_NOISE,
    GRIP_NOISE,
    LINKAGE,
    MODEL,
    MUSCLE,
    PRESSURE_NOISE,
    REGULATOR,
    Hidden,
    Moment,
    nothing,
    textbook,
    without,
)

SIZES = (65, 58, 41, 30, 58, 20, 72, 41)
"""Of the objects, in the order in which they are gripped. [mm]"""
TOPS = (450, 400, 480, 430, 400, 490, 350, 480)
"""Highest pressure on each. [kPa]"""
OPENING_NOISE = 1e-4
BETWEEN = 60.0
"""From the start of one grasp to that of the next. [s]"""
JAWS = replace(MODEL, linkage=LINKAGE)


def tiring(moment: Moment) -> Array:
    """A muscle that loses 5 % of its pull, the first grasps most of it."""
    grasps = moment.time[0] / BETWEEN
    lost: Array = textbook(moment) * (0.05 * np.expm1(-grasps / 3))
    return lost


def grasped(hidden: Hidden, bend: float = 0.0) -> Recording:
    """Jaws close on one object after the other, press, and let go of some pressure.

    They bend by so much per newton of their grip, and the muscle has a cell. [m/N]
    """
    runs = tuple(_grasp(place, hidden, bend) for place in range(len(SIZES)))
    return Recording("jaws", "0" * 64, runs)


def gripped(hidden: Hidden) -> Recording:
    """The same without a cell, by jaws that do not bend."""
    return without(grasped(hidden), "force")


def _grasp(place: int, hidden: Hidden, bend: float) -> Run:
    since = np.arange(0.0, 20.0, 0.1)
    shut = (LINKAGE.open_width - SIZES[place] * MILLI) / (
        LINKAGE.ratio * MUSCLE.rest_length
    )
    way = np.interp(since, [1.0, 4.0], [0.0, shut])
    pressure = KILO * np.interp(
        since, [0, 1, 4, 10, 14, 18], [0, 80, 200, *2 * [TOPS[place]], 250]
    )
    moment = Moment(BETWEEN * place + since, pressure, way, np.ones_like(since))
    pull = textbook(moment) + hidden(moment)
    spring = 240.0 + 1000.0 * MUSCLE.rest_length * way
    grip = np.where(way == shut, np.fmax(pull - spring, 0.0) / 4.0, 0.0)
    opening = LINKAGE.opening(way, MUSCLE.rest_length) + bend * grip
    random = np.random.default_rng([place, 7])

    def read(value: object, noise: float) -> Array:
        return np.asarray(value) + random.normal(0.0, noise, since.size)

    return Run(
        f"grasp{place}",
        {
            "time": moment.time,
            "current": np.asarray(REGULATOR.current(pressure)),
            "pressure": read(pressure, PRESSURE_NOISE),
            "opening": read(opening, OPENING_NOISE),
            "grip": read(grip, GRIP_NOISE),
            "force": read(pull, FORCE_NOISE),
        },
    )


@pytest.fixture(scope="module")
def sound() -> Diagnosis:
    return diagnose(gripped(nothing), JAWS, {}, EFFECTS)


def test_a_sound_gripper_lacks_nothing(sound: Diagnosis) -> None:
    gap = sound.gaps[Signal.GRIP]
    assert sound.verdict is Verdict.NONE
    assert sound.main is Signal.GRIP
    assert gap.before < 1.2 * gap.noise_floor < 1.2 * 1.5 * GRIP_NOISE


def test_what_takes_the_place_of_a_sensor_is_told(sound: Diagnosis) -> None:
    told = " ".join(sound.recording.remarks)
    assert "opens as far as opening_mm" in told
    assert "force_N was not measured" in told
    assert sound.untested["force_sensor_gain"] == "force not measured"
    assert "opening" in sound.untested["linkage_backlash"]
    assert "opening" in sound.untested["jaw_compliance"]
    assert "both ways under a grip" in sound.untested["pressure_hysteresis"]


def test_a_model_without_a_gripper_says_so() -> None:
    valveless = without(gripped(nothing), "current")
    with pytest.raises(InputError, match="the model has no gripper, so that opening"):
        diagnose(valveless, MODEL, {}, EFFECTS)


def test_a_muscle_that_tires_is_named_by_its_grip() -> None:
    found = diagnose(gripped(tiring), JAWS, {}, EFFECTS)
    gap = found.gaps[Signal.GRIP]
    assert found.verdict is Verdict.NAMED
    assert [entry.name for entry in found.named] == ["fatigue"]
    assert gap.after < min(1.5 * gap.noise_floor, 0.3 * gap.recalibrated)


def test_jaws_that_open_wider_than_thought_are_told_by_the_grip() -> None:
    wide = replace(LINKAGE, open_width=LINKAGE.open_width + 3e-3)
    model = replace(MODEL, linkage=wide)
    found = diagnose(gripped(nothing), model, {"gripper.open_width": 3e-3}, {})
    gap = found.gaps[Signal.GRIP]
    assert gap.before > 3 * gap.noise_floor
    assert gap.recalibrated < 1.2 * gap.noise_floor
    paths = [constant.path for constant in found.split.train.constants]
    shift = found.recalibrated.shifts[paths.index("gripper.open_width")]
    assert shift == pytest.approx(-1, abs=0.3)


def test_jaws_that_bend_are_told_by_the_pull_of_a_muscle_that_seems_longer() -> None:
    found = diagnose(grasped(nothing, bend=4e-5), JAWS, {}, EFFECTS)
    gap = found.gaps[Signal.FORCE]
    (entry,) = found.named
    assert entry.name == "jaw_compliance"
    assert set(entry.equivalents) <= {"series_compliance"}
    assert entry.parameters["compliance"].value == pytest.approx(4e-5, rel=0.1)
    assert gap.after < 1.1 * gap.noise_floor < 0.2 * gap.before


def test_what_bends_about_an_object_turns_no_friction_round() -> None:
    for bend in (0.0, 4e-5):
        problem = problem_of(grasped(nothing, bend=bend), JAWS, {})
        for course in problem.courses:
            pressed = course.column("grip") > 20 * GRIP_NOISE
            assert pressed.sum() > 50
            assert np.all(course.direction[pressed] == 1)
