import pytest

from gripperd.recordings import read_recording
from tests.recordings.conftest import Complaint, Write, good

MEASURED = {
    "current_mA": 12,
    "pressure_kPa": 250,
    "contraction": 0.1,
    "length_mm": 225,
    "force_N": 300,
    "opening_mm": 50,
    "grip_N": 15,
}


def _columns(*names: str, rows: int = 20) -> dict[str, list[object]]:
    start: dict[str, list[object]] = {"run": ["a"] * rows, "t_s": list(range(rows))}
    return start | {name: [MEASURED[name]] * rows for name in names}


@pytest.mark.parametrize(
    "names",
    [
        ("current_mA", "pressure_kPa"),
        ("pressure_kPa", "contraction", "force_N"),
        ("pressure_kPa", "length_mm", "force_N"),
        ("contraction", "opening_mm"),
        ("length_mm", "opening_mm"),
        ("force_N", "contraction", "grip_N"),
        ("force_N", "length_mm", "grip_N"),
        ("force_N", "opening_mm", "grip_N"),
        ("pressure_kPa", "contraction", "grip_N"),
        ("pressure_kPa", "length_mm", "grip_N"),
        ("pressure_kPa", "opening_mm", "grip_N"),
        ("pressure_kPa", "opening_mm", "force_N"),
    ],
)
def test_two_neighbours_of_the_chain_are_enough(
    write: Write, names: tuple[str, ...]
) -> None:
    recording = read_recording(write(_columns(*names)))
    assert len(recording.runs[0]) == 20


@pytest.mark.parametrize(
    "names",
    [
        (),
        ("force_N",),
        ("pressure_kPa", "force_N"),
        ("contraction", "force_N"),
        ("current_mA", "force_N", "contraction"),
        ("pressure_kPa", "grip_N"),
        ("current_mA", "opening_mm", "grip_N"),
    ],
)
def test_points_that_are_no_neighbours_are_refused(
    write: Write, complaint: Complaint, names: tuple[str, ...]
) -> None:
    message = complaint(write(_columns(*names)))
    assert message.startswith("rig.csv: what was measured (")
    assert "needed at least: current_mA and pressure_kPa; or" in message
    assert all(name in message for name in names)


def test_nineteen_rows_are_too_few(write: Write, complaint: Complaint) -> None:
    message = complaint(write(good(19)))
    assert message == "rig.csv: 19 of 19 rows are usable; needed at least 20"


def test_rows_that_were_dropped_are_told(write: Write, complaint: Complaint) -> None:
    stopped = good(60) | {"t_s": [0.0] * 50 + [float(row) for row in range(1, 11)]}
    assert complaint(write(stopped)) == (
        "rig.csv: 11 of 60 rows are usable; needed at least 20"
        " (left out: 49 times t_s same time as before)"
    )


def test_rows_count_where_neighbours_were_measured_together(
    write: Write, complaint: Complaint
) -> None:
    columns = _columns("current_mA", "pressure_kPa", rows=40)
    columns["current_mA"][:20] = [""] * 20
    columns["pressure_kPa"][20:] = [""] * 20
    assert "0 of 40 rows are usable" in complaint(write(columns))


def test_what_was_left_out_is_said_when_too_little_remains(
    write: Write, complaint: Complaint
) -> None:
    columns = _columns("current_mA", "pressure_kPa")
    columns["current_mA"] = [1.07] * 20
    message = complaint(write(columns))
    assert message.endswith("(left out: 20 times current_mA under 3.6 mA)")


def test_a_contraction_in_percent_is_told(write: Write, complaint: Complaint) -> None:
    columns = good(60)
    columns["contraction"][29:] = [10.0] * 11 + [""] * 20
    assert complaint(write(columns)) == (
        "rig.csv: column contraction is above 1 in 11 of 40 readings; it is a ratio,"
        " counted from the rest length: 0.1 for 10 %"
    )


@pytest.mark.parametrize(
    ("zero", "factor", "said"),
    [
        (0.004, 1e-3, "below 0.021 mA in 40 of 40 readings; is it in A?"),
        (0.0, 100 / 16, "above 21 mA in 31 of 40 readings; is it in %?"),
    ],
)
def test_a_current_in_another_unit_is_told(
    write: Write, complaint: Complaint, zero: float, factor: float, said: str
) -> None:
    columns = good(40)
    columns["current_mA"] = [zero + factor * 0.4 * row for row in range(40)]
    assert complaint(write(columns)) == f"rig.csv: column current_mA is {said}"


@pytest.mark.parametrize("dead", [0.0, 0.002, 23.0])
def test_a_loop_that_is_broken_now_and_then_is_left_out(
    write: Write, dead: float
) -> None:
    columns = good(40)
    columns["current_mA"] = [*(4 + 0.4 * row for row in range(32)), *[dead] * 8]
    recording = read_recording(write(columns))
    assert sum(one.count for one in recording.rejected) == 8


def test_a_broken_sensor_of_contraction_is_left_out(write: Write) -> None:
    columns = good(40)
    columns["contraction"][:10] = [10.0] * 10
    rejected = read_recording(write(columns)).rejected
    assert [(one.column, one.count) for one in rejected] == [("contraction", 10)]
