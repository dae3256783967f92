"""Rows that a lost link has left without a reading."""

import numpy as np
import pytest

from gripperd.diagnose.readings.recording import Run
from gripperd.diagnose.readings.screening import screened
from tests.diagnose.sweep import noise, run, triangle

LOST = [60, 61, 200, 340]


def _run(low: float = 50e3, lost: list[int] = LOST, *without: str) -> Run:
    pressure = triangle(low=low)
    columns = {
        "pressure": pressure + noise(400, 1e3, 1),
        "contraction": 0.1 + noise(400, 1e-4, 2),
        "force": 2e-3 * pressure + noise(400, 2.0, 3),
        "temperature": 295.0 + noise(400, 0.1, 4),
        "current": 4e-3 + 16e-3 * pressure / 500e3,
    }
    for name in ("pressure", "contraction", "force"):
        columns[name][lost] = 0.0
    kept = {name: columns[name] for name in columns if name not in without}
    return Run("a", {"time": 0.1 * np.linspace(0, 399, 400), **kept})


def test_zeros_of_all_channels_at_once_are_no_readings() -> None:
    (found,), rejected = screened([_run()])
    for name in ("pressure", "contraction", "force", "temperature"):
        assert np.flatnonzero(np.isnan(found.columns[name])).tolist() == LOST
    assert np.isfinite(found.columns["current"]).all()
    assert {(one.count, one.reason) for one in rejected} == {
        (4, "0 in all channels at once")
    }
    # The same at any seed of the hashes.
    columns = [one.column for one in rejected]
    assert columns == ["contraction", "force_N", "pressure_kPa", "temperature_C"]


def test_a_rig_without_a_contraction_loses_rows_as_well() -> None:
    (found,), _ = screened([_run(50e3, LOST, "contraction")])
    assert np.flatnonzero(np.isnan(found.columns["force"])).tolist() == LOST


@pytest.mark.parametrize(
    ("low", "lost"),
    [
        pytest.param(50e3, [0], id="where a run begins"),
        pytest.param(50e3, [*range(190, 210)], id="for long"),
        pytest.param(0.0, [4], id="near nothing"),
    ],
)
def test_other_zeros_are_left_to_other_checks(low: float, lost: list[int]) -> None:
    _, rejected = screened([_run(low, lost)])
    assert all(one.reason != "0 in all channels at once" for one in rejected)


def test_a_vented_muscle_reads_zero() -> None:
    vented = run(
        "v",
        pressure=np.zeros(100),
        contraction=np.zeros(100),
        force=np.zeros(100),
    )
    (_, found), _ = screened([_run(lost=[]), vented])
    assert not np.isnan(found.columns["pressure"]).any()
