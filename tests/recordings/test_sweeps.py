import numpy as np
import pytest

from gripperd.diagnose.readings.recording import Rejection
from gripperd.recordings import read_recording
from tests.recordings.conftest import Complaint, Write, good


def _two(name: str = "b", start: float = 10.0) -> dict[str, list[object]]:
    first, second = good(), good()
    first["run"] = ["a"] * 30
    second["run"] = [name] * 30
    second["t_s"] = [start + 0.1 * row for row in range(30)]
    return {key: first[key] + second[key] for key in first}


def test_runs_keep_their_order_and_their_time(write: Write) -> None:
    recording = read_recording(write(_two()))
    assert [run.name for run in recording.runs] == ["a", "b"]
    assert recording.runs[1].columns["time"][0] == 10.0
    assert recording.remarks == ()


@pytest.mark.parametrize("start", [-5.0, -10.0])
def test_runs_in_another_order_than_their_clock_are_put_in_order(
    write: Write, start: float
) -> None:
    """As in a file that was sorted by name."""
    recording = read_recording(write(_two(start=start)))
    assert [run.name for run in recording.runs] == ["b", "a"]
    assert recording.runs[0].columns["time"][0] == start
    assert recording.runs[1].columns["time"][0] == 0.0
    (remark,) = recording.remarks
    assert remark == "The runs stand in another order than t_s; they were put in order."


def test_a_clock_that_starts_anew_is_put_behind_the_run_before(write: Write) -> None:
    recording = read_recording(write(_two(start=0.0)))
    time = recording.runs[1].columns["time"]
    assert time[0] == pytest.approx(2.9 + 60.0)
    assert np.diff(time) == pytest.approx(0.1)
    (remark,) = recording.remarks
    assert "t_s starts anew in 1 runs (first b)" in remark
    assert "60 s" in remark


def test_time_that_runs_backwards_is_refused_with_run_and_line(
    write: Write, complaint: Complaint
) -> None:
    columns = _two()
    columns["t_s"][33] = 10.15
    message = complaint(write(columns))
    assert message == ("rig.csv:35: t_s runs backwards in run b: 10.15 s after 10.2 s")


def test_samples_of_one_time_are_kept_once_and_reported(write: Write) -> None:
    columns = good()
    columns["t_s"][10] = columns["t_s"][11] = columns["t_s"][9]
    recording = read_recording(write(columns))
    assert recording.rejected == (Rejection("h0.10", "t_s", 2, "same time as before"),)
    assert len(recording.runs[0]) == 28
    assert (np.diff(recording.runs[0].columns["time"]) > 0).all()
    assert recording.runs[0].columns["force"][9] == columns["force_N"][9]


@pytest.mark.parametrize("cell", ["", "nan", "inf", "1.7e12"])
def test_a_sample_without_time_is_refused(
    write: Write, complaint: Complaint, cell: str
) -> None:
    columns = good()
    columns["t_s"][4] = cell
    assert complaint(write(columns)) == "rig.csv:6: t_s is empty, or beyond 1e+12 s"


@pytest.mark.parametrize("cell", ["", "  ", '""'])
def test_a_sample_without_run_is_refused(
    write: Write, complaint: Complaint, cell: str
) -> None:
    columns = good()
    columns["run"][4] = cell
    assert complaint(write(columns)) == "rig.csv:6: run is empty"


@pytest.mark.parametrize(
    ("name", "shown"),
    [
        ("red\x1b[31m", r"red\x1b[31m"),
        ("a\x07", r"a\x07"),
        ("two\nlines", r"two\nlines"),
        ("csv.\u202egpj", r"csv.\u202egpj"),
    ],
)
def test_a_name_that_moves_the_cursor_is_refused(
    write: Write, complaint: Complaint, name: str, shown: str
) -> None:
    message = complaint(write(good() | {"run": [f'"{name}"'] * 30}))
    assert message.startswith("rig.csv:2: run ")
    assert f"{shown} has characters that move the cursor" in message


def test_a_name_may_have_any_script(write: Write) -> None:
    names = ["等尺 0,10 °C"] * 30
    (run,) = read_recording(write(good() | {"run": [f'"{one}"' for one in names]})).runs
    assert run.name == names[0]


def test_a_run_torn_apart_is_refused(write: Write, complaint: Complaint) -> None:
    columns = _two()
    columns["run"][45] = "a"
    message = complaint(write(columns))
    assert message.startswith("rig.csv:47: run a goes on after another")


def test_a_counter_is_no_name_of_a_run(write: Write, complaint: Complaint) -> None:
    columns = good(2001) | {"run": list(range(2001))}
    assert "2001 different names; 2000 runs are the most" in complaint(write(columns))


@pytest.mark.parametrize("column", ["muscle", "muscle_serial", "rest_length_mm"])
def test_two_muscles_in_one_file_are_refused(
    write: Write, complaint: Complaint, column: str
) -> None:
    message = complaint(write(_two() | {column: [225] * 30 + [274] * 30}))
    assert message.startswith(f"rig.csv: column {column} names 2 muscles (225, 274)")


def test_one_muscle_by_name_is_fine(write: Write) -> None:
    names = ["A7"] * 29 + [""]
    assert read_recording(write(good() | {"muscle_serial": names})).remarks == ()
