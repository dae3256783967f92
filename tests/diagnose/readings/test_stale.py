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
    told = Recording("r", "", (run(pressure=column), run("b", pressure=column)))
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
    told = Recording(
        "r", "", (run(grip=np.full(400, np.nan)), run(grip=_held(fresh, 2)))
    )
    for found in without_stale(told).runs:
        assert np.isnan(found.columns["grip"][1::2]).all()


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
