"""Commands that are told in the row beside their own, and what only looks like it."""

import numpy as np
import pytest

from gripperd.diagnose.diagnosis import diagnose
from gripperd.diagnose.readings.clock import with_prompt_command
from gripperd.diagnose.readings.recording import Recording, Run
from gripperd.diagnose.verdict.conclude import Verdict
from gripperd.effects import EFFECTS
from gripperd.model.track import Array
from tests.diagnose import small
from tests.diagnose.sweep import noise, run

SIZE = 400
ROW = 0.1
"""Time between rows. [s]"""
LATE = (
    "current_mA is logged a row late: it is read a row earlier, and the last row of"
    " each run is left out."
)
EARLY = (
    "current_mA is logged a row early: it is read a row later, and the first row of"
    " each run is left out."
)


def _plan(rows: float = 0.0) -> Array:
    """Two ramps, then stairs that settle, as they were so many rows ago. [A]"""
    row = np.arange(SIZE) - rows
    ramp = np.interp(row, [0, 90, 180, 200], [4e-3, 18e-3, 6e-3, 6e-3])
    stairs = np.array([6e-3, 12e-3, 9e-3, 16e-3, 5e-3])
    stair = stairs[np.clip((row - 200) // 40, 0, 4).astype(int)]
    plan: Array = np.where(row < 200, ramp, stair)
    return plan


def _lagged(asked: Array, time: float) -> Array:
    """A first-order lag of a signal that stands between rows."""
    out = asked.copy()
    for i in range(1, out.size):
        out[i] = asked[i] + (out[i - 1] - asked[i]) * np.exp(-ROW / time)
    return out


def _recording(
    told: float = 0.0,
    *,
    lag: float = 0.005,
    dead: float = 0.0,
    channel: float = 0.0,
    force: bool = True,
) -> Recording:
    """A held muscle, whose pressure follows the command at 30 kPa a milliampere.

    Parameters
    ----------
    told
        Rows by which the log has the command late, below zero early.
    lag, dead
        Of the valve. [s, rows]
    channel
        Rows by which the pressure alone is read late.
    force
        Whether there is one.
    """

    def followed(rows: float) -> Array:
        return 30e6 * (_lagged(_plan(rows), lag) - 4e-3)

    columns: dict[str, Array] = {
        "time": ROW * np.arange(float(SIZE)),
        "current": _plan(told),
        "pressure": followed(dead + channel) + noise(SIZE, 1e3, 1),
        "contraction": noise(SIZE, 2e-4, 2),
    }
    if force:
        columns["force"] = 2e-3 * followed(dead) + noise(SIZE, 3.0, 3)
    return Recording("r", "", (Run("a", columns),))


@pytest.mark.parametrize("lag", [0.005, 0.06, 0.12])
def test_a_pressure_never_moves_before_its_command(lag: float) -> None:
    found = with_prompt_command(_recording(1, lag=lag))
    (sweep,) = found.runs
    assert found.remarks == (LATE,)
    assert np.array_equal(sweep.columns["current"], _plan()[: SIZE - 1])
    read = _recording(lag=lag).runs[0].columns
    for name in ("time", "pressure", "contraction", "force"):
        assert np.array_equal(sweep.columns[name], read[name][: SIZE - 1])


@pytest.mark.parametrize("lag", [0.005, 0.06, 0.12])
def test_what_all_moves_in_the_row_after_was_commanded_there(lag: float) -> None:
    found = with_prompt_command(_recording(-1, lag=lag))
    (sweep,) = found.runs
    assert found.remarks == (EARLY,)
    assert np.array_equal(sweep.columns["current"], _plan()[1:])
    read = _recording(lag=lag).runs[0].columns
    for name in ("time", "pressure", "force"):
        assert np.array_equal(sweep.columns[name], read[name][1:])


def test_a_current_that_was_read_back_is_told_late_too() -> None:
    late = _recording(1)
    columns = dict(late.runs[0].columns)
    columns["current"] = columns["current"] + noise(SIZE, 40e-6, 9)
    found = with_prompt_command(Recording("r", "", (Run("a", columns),)))
    assert found.remarks == (LATE,)


def _with_late_grip(told: Recording) -> Recording:
    """The same with a grip that is read as late as the pressure, and by one logger."""
    (only,) = told.runs
    grip = 1e-4 * (only.columns["pressure"] - 30e3)
    return Recording("r", "", (Run("a", {**only.columns, "grip": grip}),))


@pytest.mark.parametrize(
    "told",
    [
        pytest.param(_recording(), id="as it is given"),
        pytest.param(_recording(lag=0.1), id="a valve that lags"),
        pytest.param(_recording(lag=0.6, dead=1), id="with a dead time"),
        pytest.param(_recording(dead=2), id="more than a row late"),
        pytest.param(_recording(channel=1), id="a pressure channel that is late"),
        pytest.param(
            _with_late_grip(_recording(channel=1)), id="two, and a prompt one"
        ),
        pytest.param(_recording(-1, force=False), id="nothing else to tell it from"),
        pytest.param(
            Recording("r", "", (run(pressure=noise(SIZE, 1e3)),)), id="no command"
        ),
        pytest.param(
            Recording(
                "r", "", (run(current=np.full(SIZE, 8e-3), pressure=noise(SIZE, 1e3)),)
            ),
            id="one that stands",
        ),
        pytest.param(
            Recording("r", "", (run(current=_plan()[:40], pressure=_plan()[:40]),)),
            id="next to no rows",
        ),
        pytest.param(
            Recording("r", "", (run(current=_plan(), pressure=noise(SIZE, 1e3)),)),
            id="a pressure that does not follow",
        ),
    ],
)
def test_what_is_in_its_row_or_may_be_a_lag_stays(told: Recording) -> None:
    assert with_prompt_command(told) is told


def test_runs_without_a_command_keep_all_rows() -> None:
    bare = run("bare", pressure=noise(SIZE, 1e3), force=noise(SIZE, 3.0))
    late = _recording(1)
    found = with_prompt_command(Recording("r", "", (*late.runs, bare)))
    assert [len(one) for one in found.runs] == [SIZE - 1, SIZE]


@pytest.mark.parametrize("rows", [1, -1])
@pytest.mark.parametrize(
    ("hidden", "names"),
    [(small.nothing, []), (small.threshold(25.0), ["threshold_pressure"])],
)
def test_the_order_of_a_log_changes_no_verdict(
    hidden: small.Hidden, names: list[str], rows: int
) -> None:
    library = {
        name: EFFECTS[name]
        for name in ("threshold_pressure", "pressure_hysteresis", "valve_lag")
    }

    def beside(current: Array) -> Array:
        told = np.roll(current, rows)
        told[: max(rows, 0)] = current[0]
        told[current.size + min(rows, 0) :] = current[-1]
        return told

    told = small.altered(small.recording(hidden), small.moments(), "current", beside)
    found = diagnose(told, small.MODEL, {}, library)
    assert found.verdict is (Verdict.NAMED if names else Verdict.NONE)
    assert [entry.name for entry in found.named] == names
