"""Which holds a shut valve leaves alone, and which a regulator keeps."""

from collections.abc import Mapping

import numpy as np
import pytest

from gripperd.diagnose.readings.cutting import courses
from gripperd.diagnose.readings.recording import Recording, Run
from gripperd.model.track import Array

TOP, STEP = 400e3, 0.1


def _recorded(holds: Mapping[str, Array]) -> dict[str, Array]:
    """Time for which the valve may have been shut in each run. [s]"""
    runs: list[Run] = []
    start = 0.0
    for name, pressure in holds.items():
        time = start + STEP * np.arange(pressure.size)
        rng = np.random.default_rng(len(runs))
        columns = {
            "time": time,
            "current": np.full_like(time, 0.004 + 0.016 * pressure[0] / TOP),
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


@pytest.mark.parametrize(
    "holds",
    [
        pytest.param({"a": _leaking(30.0), "b": _leaking(60.0)}, id="all sink"),
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


def test_a_low_hold_beside_others_is_not_known_to_leak() -> None:
    holds = {"hold": _kept(60.0), "shut": _leaking(30.0), "low": _kept(30.0, 8e3)}
    assert not _recorded(holds)["low"].any()
