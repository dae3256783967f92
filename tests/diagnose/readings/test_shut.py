"""Which holds a shut valve leaves alone, and which a regulator keeps."""

from collections.abc import Mapping, Sequence
from types import MappingProxyType

import numpy as np
import pytest

from gripperd.diagnose.readings.cutting import courses
from gripperd.diagnose.readings.recording import Recording, Run
from gripperd.model.track import Array

TOP, STEP = 400e3, 0.1


def _recorded(
    holds: Mapping[str, Array],
    commands: Mapping[str, Sequence[tuple[int, float]]] = MappingProxyType({}),
) -> dict[str, Array]:
    """Time for which the valve may have been shut in each run. [s]"""
    runs: list[Run] = []
    start = 0.0
    for name, pressure in holds.items():
        time = start + STEP * np.arange(pressure.size)
        rng = np.random.default_rng(len(runs))
        told = pressure[0] + 0.0 * time
        for row, command in commands.get(name, ()):
            told[row:] = command
        columns = {
            "time": time,
            "current": 0.004 + 0.016 * told / TOP,
            "pressure": pressure + rng.normal(0.0, 1e3, time.size),
        }
        runs.append(Run(name, columns))
        start = time[-1] + 60.0
    found, _ = courses(Recording("holds", "0" * 64, tuple(runs)), 0.25)
    return {course.run: course.waiting for course in found}


def _lasting(seconds: float) -> Array:
    return STEP * np.arange(round(seconds / STEP), dtype=np.float64)


def _leaking(seconds: float, pace: float = 4e-3, pressure: float = TOP) -> Array:
    return pressure * np.exp(-pace * _lasting(seconds))


def _kept(seconds: float, pressure: float = TOP) -> Array:
    return pressure + 0.0 * _lasting(seconds)


def test_where_one_hold_sinks_and_another_stays_only_the_first_may_be_shut() -> None:
    waits = _recorded({"hold": _kept(60.0), "shut": _leaking(30.0)})
    assert not waits["hold"].any()
    np.testing.assert_allclose(waits["shut"], _lasting(30.0))


def test_holds_that_stay_tell_together_what_none_of_them_tells_alone() -> None:
    # Each would have lost 8 kPa: little more than a sensor may drift, in any of them.
    stay = {name: _kept(25.0) for name in "abcde"}
    waits = _recorded({**stay, "shut": _leaking(46.0, 8e-4)})
    assert not any(waits[name].any() for name in stay)
    np.testing.assert_allclose(waits["shut"], _lasting(46.0))


@pytest.mark.parametrize(
    "holds",
    [
        pytest.param({"a": _leaking(30.0), "b": _leaking(60.0)}, id="all sink"),
        pytest.param(
            # A hole whose flow is as the power 1.5 of the pressure.
            {
                **{name: _leaking(55.0, 6.3e-4, 0.4 * TOP) for name in "abcde"},
                "f": _leaking(30.0, 1e-3),
            },
            id="those at low pressure sink less than a sensor drifts",
        ),
        pytest.param({"a": _kept(30.0), "b": _kept(60.0)}, id="none sinks"),
        pytest.param({"a": _kept(3.0), "b": _leaking(30.0)}, id="one is too short"),
        pytest.param(
            {"a": _kept(30.0, 0.02 * TOP), "b": _leaking(30.0)}, id="one is too low"
        ),
        pytest.param(
            {"a": _leaking(60.0, 2e-3), "b": _leaking(30.0)},
            id="one sinks half as fast",
        ),
        pytest.param(
            {"a": _kept(60.0), "b": _leaking(30.0, 4e-4)}, id="as a sensor drifts"
        ),
    ],
)
def test_else_the_valve_may_be_shut_whenever_the_command_rests(
    holds: dict[str, Array],
) -> None:
    for name, waits in _recorded(holds).items():
        np.testing.assert_allclose(waits, STEP * np.arange(holds[name].size))


def test_a_regulator_that_is_late_after_a_step_down_is_not_shut() -> None:
    late = TOP * (0.5 + 0.5 * np.exp(-_lasting(30.0) / 3.0))
    waits = _recorded({"hold": _kept(60.0), "late": late})
    assert waits["hold"].any()


@pytest.mark.parametrize(
    "other",
    [
        pytest.param(_kept(30.0, 8e3), id="too low"),
        pytest.param(_kept(4.0), id="too short"),
        pytest.param(_leaking(7.0, 4e-3, 0.5 * TOP), id="too little to lose"),
    ],
)
def test_a_hold_that_shows_nothing_is_taken_for_kept_where_one_is(
    other: Array,
) -> None:
    waits = _recorded({"hold": _kept(60.0), "shut": _leaking(30.0), "other": other})
    assert not waits["hold"].any()
    assert not waits["other"].any()


def test_the_slowest_leak_is_what_a_hold_is_held_against() -> None:
    # In 20 s at half the pressure the slow one would lose 1 % of the highest, which
    # nobody sees, the quick one 11 %.
    kept = _kept(20.0, 0.5 * TOP)
    leaks = {"slow": _leaking(60.0, 1e-3), "quick": _leaking(60.0, 1.2e-2)}
    told = _recorded({**leaks, "kept": kept})["kept"]
    np.testing.assert_allclose(told, _lasting(20.0))
    assert not _recorded({"quick": leaks["quick"], "kept": kept})["kept"].any()


def test_each_hold_of_a_sweep_is_one_of_its_own() -> None:
    both = np.concatenate([_leaking(30.0), _kept(60.0, 0.8 * TOP)])
    waits = _recorded({"both": both}, commands={"both": [(0, TOP), (300, 0.8 * TOP)]})
    np.testing.assert_allclose(waits["both"][:300], _lasting(30.0))
    assert not waits["both"][300:].any()


def test_a_cock_that_is_shut_by_hand_amid_a_hold_is_seen_by_its_pressure() -> None:
    late = np.concatenate([_kept(20.0), _leaking(40.0)])
    waits = _recorded({"hold": _kept(60.0), "late": late})["late"]
    began = STEP * np.flatnonzero(waits > 0)[0]
    # By then it has lost twice the noise of a reading.
    assert began == pytest.approx(20.0, abs=2.0)
    np.testing.assert_allclose(waits[-1], 60.0 - began, atol=2 * STEP)


def test_a_cock_that_is_opened_amid_a_hold_ends_it() -> None:
    both = np.concatenate([_leaking(40.0), _kept(20.0)])
    waits = _recorded({"hold": _kept(60.0), "both": both})["both"]
    np.testing.assert_allclose(waits[:390], _lasting(39.0))
    assert not waits[410:].any()


def test_a_cock_that_is_opened_just_before_the_end_hides_no_leak() -> None:
    """3 % of the highest pressure are lost, and come back for the last 3 s."""
    shut = np.concatenate([_leaking(40.0, 1.5e-3, TOP / 2), _kept(3.0, TOP / 2)])
    waits = _recorded({"hold": _kept(60.0), "shut": shut})
    np.testing.assert_allclose(waits["shut"][:399], _lasting(39.9))
    assert not waits["shut"][401:].any()
    assert not waits["hold"].any()


def test_a_regulator_that_is_slow_to_fill_has_been_opened_by_nobody() -> None:
    slow = TOP * (1 - np.exp(-_lasting(30.0) / 4.0))
    told = _recorded({"slow": slow}, commands={"slow": [(0, TOP)]})["slow"]
    np.testing.assert_allclose(told, _lasting(30.0))


def test_where_all_sinks_it_begins_anew_when_the_pressure_has_come_back() -> None:
    twice = np.concatenate([_leaking(40.0), _leaking(40.0)])
    waits = _recorded({"twice": twice})["twice"]
    np.testing.assert_allclose(waits[:390], _lasting(39.0))
    np.testing.assert_allclose(waits[-1], 39.9, atol=1.0)


def test_a_hold_whose_readings_are_missing_may_be_shut_from_its_command_on() -> None:
    gone = np.concatenate([_leaking(1.0, 0.05), np.full(290, np.nan)])
    waits = _recorded({"hold": _kept(60.0), "gone": gone})["gone"]
    np.testing.assert_allclose(waits, STEP * np.arange(gone.size))
