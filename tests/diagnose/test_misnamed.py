"""What fits an effect only where nothing is that bears its name."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from scipy.signal import lfilter

from gripperd.diagnose.diagnosis import diagnose
from gripperd.diagnose.verdict.conclude import Verdict
from gripperd.effects import EFFECTS
from gripperd.model.track import Array
from tests.diagnose.small import (
    MODEL,
    MUSCLE,
    REGULATOR,
    STEP,
    Moment,
    altered,
    moments,
    nothing,
    recording,
    switched,
    textbook,
)


@pytest.mark.parametrize(
    ("way", "verdict"), [(0.004, Verdict.UNEXPLAINED), (0.025, Verdict.NAMED)]
)
def test_what_pulls_near_rest_length_alone_is_no_rubber(
    way: float, verdict: Verdict
) -> None:
    """A cable that is taut there, and a bladder that is soft after 10 mm."""

    def pulling(moment: Moment) -> Array:
        return 30.0 * np.expm1(-moment.contraction / way)

    rubber = {"nonlinear_elasticity": EFFECTS["nonlinear_elasticity"]}
    told = diagnose(recording(pulling), MODEL, {}, rubber)
    assert [entry.name for entry in told.named] == ["nonlinear_elasticity"]
    assert told.verdict is verdict


@pytest.mark.parametrize(
    ("spread", "verdict"), [(0.0, Verdict.UNEXPLAINED), (0.05, Verdict.NAMED)]
)
def test_what_snaps_at_one_length_is_no_memory_of_strands(
    spread: float, verdict: Verdict
) -> None:
    """A fold that opens at 9 % and closes at 6 %, and a bank of such switches."""
    middles = np.random.default_rng(3).normal(0.075, spread, 400)

    def folding(moment: Moment) -> Array:
        return 60.0 * switched(moment.contraction, middles, 0.015)

    memory = {"presliding_hysteresis": EFFECTS["presliding_hysteresis"]}
    told = diagnose(recording(folding), MODEL, {}, memory)
    assert [entry.name for entry in told.named] == ["presliding_hysteresis"]
    assert told.verdict is verdict


@pytest.mark.parametrize(
    ("spread", "verdict"), [(0.0, Verdict.UNEXPLAINED), (80e3, Verdict.NAMED)]
)
def test_what_snaps_at_one_pressure_is_no_memory_of_a_bladder(
    spread: float, verdict: Verdict
) -> None:
    """A fold that opens at 280 kPa and closes at 220 kPa, and a bank of such."""
    middles = np.random.default_rng(3).normal(250e3, spread, 400)

    def folding(moment: Moment) -> Array:
        return 60.0 * switched(moment.pressure, middles, 30e3)

    memory = {"pressure_hysteresis": EFFECTS["pressure_hysteresis"]}
    told = diagnose(recording(folding), MODEL, {}, memory)
    assert [entry.name for entry in told.named] == ["pressure_hysteresis"]
    assert told.verdict is verdict


@pytest.mark.parametrize(
    ("law", "name"),
    [
        (lambda p: -np.expm1(-p / 12e3), "coulomb_friction"),
        (lambda p: (p / 500e3) ** 0.7, "pressure_friction"),
    ],
)
def test_friction_that_lets_go_of_a_vented_muscle_does_not_grow_with_pressure(
    law: Callable[[Array], Array], name: str
) -> None:
    def rubbing(moment: Moment) -> Array:
        return -40.0 * moment.direction * law(moment.pressure)

    frictions = {one: EFFECTS[one] for one in ("coulomb_friction", "pressure_friction")}
    told = diagnose(recording(rubbing), MODEL, {}, frictions)
    assert [entry.name for entry in told.named] == [name]
    assert told.verdict is Verdict.NAMED


def test_stretch_that_creeps_beside_the_pull_is_no_memory_of_strands() -> None:
    """Chains of dashpots, of the pressure and of the stretch, of 2 s to a minute."""

    def creeping(moment: Moment) -> Array:
        pressed, stretched = moment.pressure / 500e3, moment.contraction / 0.2
        load = 30.0 * pressed - 25.0 * stretched
        return -sum((_late(load, time) for time in (2.0, 12.0, 60.0)), 0.0 * load)

    library = {one: EFFECTS[one] for one in ("creep", "presliding_hysteresis")}
    told = diagnose(recording(creeping), MODEL, {}, library)
    assert [entry.name for entry in told.named] == ["creep"]
    assert told.verdict is Verdict.NAMED


@pytest.mark.parametrize("share", [0.08, 0.12])
def test_a_muscle_that_gives_in_from_what_its_model_has_is_of_its_size(
    share: float,
) -> None:
    """By a stretched exponential, and so at last by 8 % or 12 % of each step."""

    def giving(moment: Moment) -> Array:
        load = moment.pressure * moment.pull_area
        given = np.zeros_like(load)
        for at, step in enumerate(np.diff(load, prepend=0.0)):
            since = np.maximum(moment.time - moment.time[at], 0.0)
            given += step * -np.expm1(-np.sqrt(since / 8.0))
        return -share * given

    tolerances = {
        f"muscle.{name}": tolerance * getattr(MUSCLE, name)
        for name, tolerance in {
            "rest_length": 0.001, "diameter": 0.002, "braid_angle": 0.002,
            "wall_thickness": 0.01, "elastic_modulus": 0.01,
        }.items()
    }  # fmt: skip
    library = {
        one: EFFECTS[one]
        for one in ("creep", "threshold_pressure", "force_sensor_gain")
    }
    told = diagnose(recording(giving), MODEL, tolerances, library)
    assert [entry.name for entry in told.named] == ["creep"]
    assert told.verdict is Verdict.NAMED


@pytest.mark.parametrize(
    ("share", "is_named"),
    [pytest.param(0.2, True, id="sags"), pytest.param(-0.2, False, id="rises")],
)
def test_a_regulator_that_gives_more_as_its_supply_sinks_does_not_sag(
    share: float, *, is_named: bool
) -> None:
    """A poppet that its supply helps to close: the supply swings by 70 kPa."""
    told = recording(nothing)
    runs = []
    for run in told.runs:
        moment = moments()[run.name]
        lost = 70e3 * (1 - np.cos(moment.time / 7.0))
        more = -share * lost * moment.pressure / 500e3
        fed = replace(moment, pressure=moment.pressure + more)
        columns = {
            **run.columns,
            "supply": 700e3 - lost,
            "pressure": run.columns["pressure"] + more,
            "force": run.columns["force"] + textbook(fed) - textbook(moment),
        }
        runs.append(replace(run, columns=columns))
    swung = replace(told, runs=tuple(runs))
    valves = ("supply_saturation", "valve_nonlinearity", "valve_gain", "valve_offset")
    found = diagnose(swung, MODEL, {}, {one: EFFECTS[one] for one in valves})
    names = [entry.name for entry in found.named]
    assert (names == ["supply_saturation"]) == is_named
    assert (found.verdict is Verdict.UNEXPLAINED) != is_named


def _late(load: Array, time: float) -> Array:
    """What has not come yet by a time constant. [N]."""
    kept = np.exp(-STEP / time)
    load = load - load[0]
    return np.asarray(load - lfilter([1 - kept], [1.0, -kept], load))


@pytest.mark.parametrize(
    ("share", "time", "verdict"),
    [(0.06, 12.0, Verdict.UNEXPLAINED), (1.0, 0.5, Verdict.NAMED)],
)
def test_a_regulator_that_goes_on_a_little_for_long_fills_no_slower(
    share: float, time: float, verdict: Verdict
) -> None:
    """A coil that warms gives some more, late."""

    def asked(pressure: Array) -> Array:
        come, late = -np.expm1(-STEP / time), float(pressure[0])
        found = []
        for level in pressure.tolist():
            goal = level - share * (1 - come) * late
            goal /= 1 - share * (1 - come)
            late += come * (goal - late)
            found.append(goal)
        return np.array(found)

    told = recording()
    for name, moment in moments().items():
        current = np.asarray(REGULATOR.current(asked(moment.pressure)))
        told = altered(told, [name], "current", partial(_instead, current))
    lag = {"valve_lag": EFFECTS["valve_lag"]}
    judged = diagnose(told, MODEL, {}, lag)
    assert [entry.name for entry in judged.named] == ["valve_lag"]
    assert judged.verdict is verdict


def _instead(read: Array, _: Array) -> Array:
    return read
