from pathlib import Path

import numpy as np
import pytest

from gripperd.diagnose.readings.recording import Kind, Recording, Run
from gripperd.errors import InputError
from gripperd.recordings import read_recording, write_recording


def _recording() -> Recording:
    time = np.arange(25.0)
    muscle = {
        "time": time,
        "pressure": np.linspace(1e5, 4e5, 25),
        "contraction": np.full(25, 0.05),
        "force": np.where(time == 7, np.nan, 10 * time),
    }
    valve = {
        "time": 100 + time,
        "pressure": np.linspace(1e5, 4e5, 25),
        "current": np.linspace(0.006, 0.012, 25),
        "temperature": np.full(25, 295.0),
    }
    runs = (Run("pull", muscle, Kind.ISOMETRIC), Run("valve, slow", valve))
    return Recording("rig", "", runs, noise={"force": 5.0, "pressure": 1500.0})


@pytest.mark.parametrize("suffix", [".csv", ".parquet"])
def test_what_is_written_is_read_again(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"rig{suffix}"
    write_recording(_recording(), path)
    back = read_recording(path)
    assert [run.name for run in back.runs] == ["pull", "valve, slow"]
    assert [run.kind for run in back.runs] == [Kind.ISOMETRIC, None]
    assert back.noise == {"force": 5.0, "pressure": 1500.0}
    assert back.rejected == ()
    for run, same in zip(_recording().runs, back.runs, strict=True):
        for key, values in run.columns.items():
            np.testing.assert_allclose(same.columns[key], values, rtol=1e-12)


def test_what_is_not_measured_is_an_empty_cell(tmp_path: Path) -> None:
    write_recording(_recording(), tmp_path / "rig.csv")
    lines = (tmp_path / "rig.csv").read_text().splitlines()
    assert lines[0].replace('"', "") == (
        "run,t_s,current_mA,pressure_kPa,contraction,force_N,temperature_C"
    )
    assert lines[8] == '"pull",7,,187.5,0.05,,'


def test_another_suffix_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"written as \.csv or \.parquet"):
        write_recording(_recording(), tmp_path / "rig.xlsx")
