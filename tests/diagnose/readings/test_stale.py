"""Loggers that are faster than a channel, and channels that are merely coarse."""

import numpy as np
import pytest

from gripperd.diagnose.diagnosis import diagnose
from gripperd.diagnose.readings.recording import Recording
from gripperd.diagnose.readings.stale import without_stale
from gripperd.diagnose.verdict.conclude import Verdict
from gripperd.effects import EFFECTS
from gripperd.model.track import Array
from tests.diagnose.small import (
    MODEL,
    Hidden,
    altered,
    moments,
    nothing,
    recording,
    threshold,
)
from tests.diagnose.sweep import noise, run, triangle


def _held(column: Array, rows: int) -> Array:
    return column[np.arange(column.size) // rows * rows]


def _read(column: Array) -> Array:
    fresh = noise(column.size, 3.0)
    told = Recording(
        "r", "", tuple(run(name, pressure=column, force=fresh) for name in "ab")
    )
    found = without_stale(told)
    return found.runs[1].columns["pressure"]


@pytest.mark.parametrize("rows", [2, 3, 6])
def test_of_a_reading_that_is_told_again_the_first_counts(rows: int) -> None:
    fresh = triangle() + noise(400, 1e3)
    found = _read(_held(fresh, rows))
    first = np.arange(400) % rows == 0
    assert np.array_equal(found[first], fresh[first])
    assert np.isnan(found[~first]).all()


def test_a_channel_that_is_read_in_one_run_alone_is_told_again_there() -> None:
    fresh = triangle() + noise(400, 1e3)
    pull = noise(400, 3.0)
    told = Recording(
        "r",
        "",
        (
            run(grip=np.full(400, np.nan), force=pull),
            run(grip=_held(fresh, 2), force=pull),
        ),
    )
    for found in without_stale(told).runs:
        assert np.isnan(found.columns["grip"][1::2]).all()


def test_a_row_in_which_all_is_told_again_is_none() -> None:
    fresh, pull = triangle() + noise(400, 1e3), 100.0 + noise(400, 3.0)
    still = np.full(400, 0.1)
    told = run(
        current=_held(1e-8 * triangle(), 2),
        pressure=_held(fresh, 2),
        contraction=still,
        force=_held(pull, 2),
        # Slower still, and so told again in rows that are others' own.
        supply=_held(6e5 + noise(400, 1e3, 4), 4),
    )
    (found,) = without_stale(Recording("r", "", (told,))).runs
    assert found.columns["time"] == pytest.approx(0.2 * np.arange(200))
    assert np.array_equal(found.columns["pressure"], fresh[::2])
    assert np.array_equal(found.columns["force"], pull[::2])
    assert np.array_equal(found.columns["contraction"], still[::2])


@pytest.mark.parametrize("step", [0.0, 8e3])
def test_beside_a_channel_that_goes_on_rows_stay(step: float) -> None:
    pressure = triangle() + noise(400, 1e3)
    if step:
        # A coarse converter: two of three readings are like the one before.
        pressure = np.round(triangle() / step) * step
        assert 0.5 < np.mean(np.diff(pressure) == 0) < 0.8
    pull = 100.0 + noise(400, 3.0)
    told = run(pressure=pressure, force=_held(pull, 2))
    (found,) = without_stale(Recording("r", "", (told,))).runs
    assert np.array_equal(found.columns["pressure"], pressure)
    assert np.array_equal(found.columns["force"][::2], pull[::2])


def test_it_is_remarked() -> None:
    held = _held(triangle() + noise(400, 1e3), 3)
    (remark,) = without_stale(Recording("r", "", (run(pressure=held),))).remarks
    assert remark == "pressure_kPa tells each reading 3 times: the first counts."


@pytest.mark.parametrize(
    "column",
    [
        pytest.param(triangle() + noise(400, 1e3), id="a channel as fast"),
        pytest.param(np.full(400, 3e5), id="one that stands"),
        pytest.param(np.round(triangle() / 4e3) * 4e3, id="a coarse converter"),
        pytest.param(
            np.round((triangle() + noise(400, 1e3)) / 2e3) * 2e3, id="and its noise"
        ),
    ],
)
def test_what_is_fresh_or_merely_coarse_stays(column: Array) -> None:
    assert np.array_equal(_read(column), column)


def test_a_channel_that_stands_for_long_amid_readings_stays_there() -> None:
    held = _held(triangle() + noise(400, 1e3), 2)
    held[100:160] = 0.0
    assert not _read(held)[100:160].any()


@pytest.mark.parametrize(
    ("hidden", "verdict"), [(nothing, Verdict.NONE), (threshold(25.0), Verdict.NAMED)]
)
def test_a_slow_channel_changes_no_verdict(hidden: Hidden, verdict: Verdict) -> None:
    library = {
        name: EFFECTS[name]
        for name in ("threshold_pressure", "pressure_hysteresis", "channel_delay")
    }
    told = recording(hidden)
    for column in ("pressure", "contraction"):
        told = altered(told, moments(), column, lambda values: _held(values, 2))
    found = diagnose(told, MODEL, {}, library)
    assert found.verdict is verdict
    names = [entry.name for entry in found.named]
    assert names == (["threshold_pressure"] if verdict is Verdict.NAMED else [])
