"""Measured muscles, where somebody has them: a folder named by the environment."""

import os
from pathlib import Path

import numpy as np
import pytest

from gripperd.diagnose.readings.recording import Recording
from gripperd.recordings import read_recording

FOLDER = os.environ.get("GRIPPERD_MEASURED")

pytestmark = pytest.mark.skipif(
    not FOLDER, reason="GRIPPERD_MEASURED names no folder of measured recordings"
)


def _measured(name: str) -> Recording:
    return read_recording(Path(FOLDER or "") / f"{name}.csv")


def _rejected(recording: Recording) -> dict[str, int]:
    counts: dict[str, int] = {}
    for entry in recording.rejected:
        counts[entry.reason] = counts.get(entry.reason, 0) + entry.count
    return counts


def test_a_static_map_is_accepted_without_its_slack_zeros() -> None:
    recording = _measured("dmsp20_map")
    assert [len(run) for run in recording.runs] == [21] * 6
    assert _rejected(recording) == {"no tension: exactly 0 N": 66}
    assert recording.contradictions == ()


def test_the_slipped_mount_contradicts_the_other_sweeps() -> None:
    recording = _measured("festo20_rest225mm")
    (found,) = recording.contradictions
    assert len(found.runs) == len(found.others) == 10
    assert all(name.startswith("h0.0844s_") for name in found.runs)
    assert all(name.startswith("h0.0844_") for name in found.others)
    assert found.column == "force_N"
    assert -200 < found.difference < -100
    assert found.spread < 10
    assert set(_rejected(recording)) == {
        "no tension: exactly 0 N",
        "at the floor of the channel, -18.595 N",
    }


def test_a_first_cycle_that_differs_is_no_contradiction() -> None:
    recording = _measured("festo20_rest274mm")
    assert recording.contradictions == ()
    assert set(_rejected(recording)) == {"at the floor of the channel, -18.595 N"}


@pytest.mark.parametrize("name", ["pam10_characterization", "pam10_steps"])
def test_a_healthy_rig_with_steps_loses_nothing(name: str) -> None:
    recording = _measured(name)
    assert recording.rejected == ()
    assert recording.contradictions == ()
    assert recording.has("supply")


def test_blank_cells_of_the_supply_stay_blank() -> None:
    (run,) = _measured("pam10_characterization").runs
    assert len(run) == 8032
    assert np.isnan(run.columns["supply"]).sum() == 13
