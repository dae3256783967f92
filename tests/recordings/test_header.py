import pytest

from gripperd.recordings import read_recording
from tests.recordings.conftest import Complaint, Write, good


@pytest.mark.parametrize("name", ["run", "t_s"])
def test_a_required_column_is_missed_by_name(
    write: Write, complaint: Complaint, name: str
) -> None:
    columns = good()
    del columns[name]
    assert complaint(write(columns)).startswith(f"rig.csv: column {name} is missing")


@pytest.mark.parametrize(
    ("wrong", "right"),
    [
        ("force_lbf", "force_N"),
        ("force_kN", "force_N"),
        ("Force_N", "force_N"),
        ("force [N]", "force_N"),
        ("force", "force_N"),
        ("pressure_bar", "pressure_kPa"),
        ("pressure_MPa", "pressure_kPa"),
        ("pressure_psi", "pressure_kPa"),
        ("contraction_percent", "contraction"),
        ("contraction_%", "contraction"),
        ("contraction_mm", "contraction"),
    ],
)
def test_a_known_quantity_in_another_unit_is_refused_with_the_unit_expected(
    write: Write, complaint: Complaint, wrong: str, right: str
) -> None:
    columns = {wrong if name == right else name: v for name, v in good().items()}
    message = complaint(write(columns))
    assert message.startswith(f'rig.csv: column "{wrong}": ')
    assert message.endswith(f'in a column "{right}"')


@pytest.mark.parametrize(
    ("wrong", "right"),
    [
        ("temperature_K", "temperature_C"),
        ("current_A", "current_mA"),
        ("length_m", "length_mm"),
        ("opening_cm", "opening_mm"),
        ("supply_bar", "supply_kPa"),
    ],
)
def test_an_optional_quantity_in_another_unit_is_refused_too(
    write: Write, complaint: Complaint, wrong: str, right: str
) -> None:
    assert f'"{right}"' in complaint(write(good() | {wrong: [1] * 30}))


@pytest.mark.parametrize("name", ["operator", "force_raw", "h", "valve open?"])
def test_a_column_nobody_knows_is_left_alone_and_said_to_be(
    write: Write, name: str
) -> None:
    recording = read_recording(write(good() | {name: ["x"] * 30}))
    assert recording.remarks == (f'Column "{name}" is not read.',)


def test_another_unit_beside_the_right_one_is_left_alone(write: Write) -> None:
    recording = read_recording(write(good() | {"force_lbf": [1] * 30}))
    assert recording.remarks == ('Column "force_lbf" is not read.',)


def test_a_column_in_the_unit_of_one_that_is_missing_may_be_meant_for_it(
    write: Write,
) -> None:
    columns = good() | {"current_mA": [4.0 + 0.2 * row for row in range(30)]}
    columns["F_N"] = columns.pop("force_N")
    (remark,) = read_recording(write(columns)).remarks
    assert remark == 'Column "F_N" is not read; is it force_N or grip_N?'


def test_a_name_that_stands_twice_is_refused(
    write: Write, complaint: Complaint
) -> None:
    path = write(good())
    path.write_text(path.read_text().replace("pressure_kPa", "force_N", 1))
    assert complaint(path) == 'rig.csv: column "force_N" stands 2 times'
