import hashlib
import os
import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from gripperd.errors import InputError
from gripperd.recordings import read_recording
from tests.recordings.conftest import Complaint, Write, good


def test_every_column_of_the_contract_arrives_in_si(write: Write) -> None:
    rows = 20
    path = write(
        {
            "run": ["a"] * rows,
            "t_s": range(rows),
            "current_mA": [12] * rows,
            "pressure_kPa": [250] * rows,
            "contraction": [0.05] * rows,
            "length_mm": [237.5] * rows,
            "force_N": [300] * rows,
            "opening_mm": [60] * rows,
            "grip_N": [15] * rows,
            "object_mm": [58] * rows,
            "temperature_C": [21.5] * rows,
            "supply_kPa": [600] * rows,
            "ambient_kPa": [98] * rows,
        }
    )
    (run,) = read_recording(path).runs
    first = {key: values[0] for key, values in run.columns.items()}
    assert first == pytest.approx(
        {
            "time": 0.0,
            "current": 0.012,
            "pressure": 250e3,
            "contraction": 0.05,
            "length": 0.2375,
            "force": 300.0,
            "opening": 0.060,
            "grip": 15.0,
            "object": 0.058,
            "temperature": 294.65,
            "supply": 600e3,
            "ambient": 98e3,
        }
    )


def test_a_recording_is_named_after_its_file_and_known_by_its_bytes(
    write: Write,
) -> None:
    path = write(good())
    recording = read_recording(path)
    assert recording.name == "rig"
    assert recording.digest == hashlib.sha256(path.read_bytes()).hexdigest()


def test_an_empty_cell_is_not_measured(write: Write) -> None:
    columns = good() | {"supply_kPa": [""] * 5 + [600] * 25}
    recording = read_recording(write(columns))
    supply = recording.runs[0].columns["supply"]
    assert np.isnan(supply[:5]).all()
    assert (supply[5:] == 600e3).all()
    assert recording.rejected == ()


def test_an_empty_column_is_not_measured_and_said_to_be(write: Write) -> None:
    recording = read_recording(write(good() | {"grip_N": [""] * 30}))
    assert "grip" not in recording.runs[0].columns
    assert recording.remarks == ("Column grip_N is empty: not measured.",)


def test_a_column_of_which_nothing_is_believed_is_the_first_remark(
    write: Write,
) -> None:
    columns = good() | {"current_mA": [0.0] * 29 + [25.0]} | {"grip_N": [""] * 30}
    recording = read_recording(write(columns))
    assert recording.remarks == (
        "Every reading of current_mA is rejected: under 3.6 mA, above 21 mA.",
        "Column grip_N is empty: not measured.",
    )


def test_a_column_with_one_reading_that_is_believed_is_not_lost(write: Write) -> None:
    recording = read_recording(write(good() | {"current_mA": [0.0] * 29 + [4.0]}))
    assert recording.rejected[0].count == 29
    assert recording.remarks == ()


def test_readings_that_are_no_number_are_reported(write: Write) -> None:
    columns = good()
    columns["force_N"][3] = "inf"
    columns["force_N"][9] = "-inf"
    columns["force_N"][12] = "nan"
    (rejection,) = read_recording(write(columns)).rejected
    assert (rejection.column, rejection.count) == ("force_N", 2)
    assert rejection.reason == "not a finite number"


def test_absurd_numbers_are_left_out(write: Write) -> None:
    columns = good()
    columns["force_N"][3] = columns["pressure_kPa"][9] = "1e308"
    said = [entry.reason for entry in read_recording(write(columns)).rejected]
    assert sorted(said) == ["above 1e+12 N", "not a finite number"]


def test_a_dropout_of_the_current_is_left_out_and_the_live_zero_is_not(
    write: Write,
) -> None:
    current = [4.0] * 28 + [0.0, 22.0]
    recording = read_recording(write(good() | {"current_mA": current}))
    said = {(entry.count, entry.reason) for entry in recording.rejected}
    assert said == {(1, "under 3.6 mA"), (1, "above 21 mA")}
    assert recording.rejected[0].column == "current_mA"
    assert np.isnan(recording.runs[0].columns["current"]).sum() == 2


@pytest.mark.parametrize(
    ("content", "detail"),
    [
        (b"", "rig.csv: is empty"),
        (b"\n\n\n", "rig.csv: is empty"),
        (b"\x7fELF\0\0\0\x01", "rig.csv: is neither a CSV file in UTF-8 nor Parquet"),
        ("run,t_s\n".encode("utf-16"), "rig.csv: is neither a CSV file in UTF-8"),
        (b"PAR1 and then nothing of it", "rig.csv: is a damaged Parquet file"),
        (b"run,t_s,force_N\n", "there are names of columns, and no rows"),
    ],
)
def test_a_file_that_holds_no_recording_is_refused(
    tmp_path: Path, complaint: Complaint, content: bytes, detail: str
) -> None:
    path = tmp_path / "rig.csv"
    path.write_bytes(content)
    assert detail in complaint(path)


def test_a_folder_or_nothing_at_all_is_refused(
    tmp_path: Path, complaint: Complaint
) -> None:
    assert complaint(tmp_path / "rig.csv") == "rig.csv: there is no such file"
    (tmp_path / "rig").mkdir()
    assert complaint(tmp_path / "rig") == "rig: is not a file"


def test_a_pipe_is_refused_and_not_waited_for(
    tmp_path: Path, complaint: Complaint
) -> None:
    os.mkfifo(tmp_path / "rig.csv")
    assert complaint(tmp_path / "rig.csv") == "rig.csv: is not a file"


def test_a_file_that_is_too_large_is_refused_before_it_is_read(
    tmp_path: Path, complaint: Complaint
) -> None:
    path = tmp_path / "rig.csv"
    path.touch()
    os.truncate(path, 2 * 2**30)
    assert complaint(path).startswith("rig.csv: 2048 MB are more than 512 MB")


def test_a_million_rows_are_read(tmp_path: Path) -> None:
    rows, runs = 1_000_000, 10
    time = np.arange(rows) * 0.01
    lines = [f"r{row * runs // rows},{time[row]:.2f},12,250" for row in range(rows)]
    path = tmp_path / "rig.csv"
    path.write_text("run,t_s,current_mA,pressure_kPa\n" + "\n".join(lines))
    recording = read_recording(path)
    assert [len(run) for run in recording.runs] == [rows // runs] * runs
    assert recording.runs[-1].columns["time"][-1] == time[-1]


@given(st.binary(max_size=400))
@settings(
    max_examples=60,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
def test_no_bytes_at_all_escape_with_another_error(
    tmp_path: Path, content: bytes
) -> None:
    path = tmp_path / "rig.csv"
    for start in (b"", b"run,t_s,current_mA,pressure_kPa\n", b"PAR1"):
        path.write_bytes(start + content)
        with pytest.raises(InputError):
            read_recording(path)


CELL = st.one_of(
    st.floats().map(str),
    st.integers().map(str),
    st.text(
        st.characters(categories=("L", "N", "P", "S"), exclude_characters='"'),
        max_size=6,
    ),
    st.sampled_from(["", "nan", "1,5", "1e999", " 7 ", "0x10", "1_0", "٣"]),
)


@given(st.lists(st.tuples(CELL, CELL), min_size=20, max_size=30))
@settings(
    max_examples=50,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
def test_odd_cells_are_read_or_refused_with_their_line(
    tmp_path: Path, cells: list[tuple[str, str]]
) -> None:
    path = tmp_path / "rig.csv"
    rows = (f'a,{row},"{one}","{two}"' for row, (one, two) in enumerate(cells))
    text = "\n".join(["run,t_s,current_mA,pressure_kPa", *rows])
    path.write_bytes(text.encode())
    refusal = _refusal(path)
    if refusal is None:
        (run,) = read_recording(path).runs
        assert len(run) == len(cells)
        assert not any(np.isinf(values).any() for values in run.columns.values())
    else:
        assert re.search(r"rig\.csv:\d+: |are usable|links no two points", refusal)


def _refusal(path: Path) -> str | None:
    try:
        read_recording(path)
    except InputError as refused:
        return str(refused)
    return None
