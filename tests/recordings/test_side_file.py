import pytest

from gripperd.diagnose.readings.recording import Kind
from gripperd.recordings import read_recording
from tests.recordings.conftest import Complaint, Write, good


def test_kinds_and_noise_are_taken_from_the_side_file(write: Write) -> None:
    path = write(good())
    path.with_suffix(".yaml").write_text(
        "rig: bench 2\nmuscle_serial: A7\nnotes: after service\n"
        "noise: {force_N: 5, pressure_kPa: 1.5, temperature_C: 0.2}\n"
        "runs: {h0.10: {kind: isometric}}\n"
    )
    recording = read_recording(path)
    assert recording.runs[0].kind is Kind.ISOMETRIC
    assert recording.noise == {"force": 5.0, "pressure": 1500.0, "temperature": 0.2}
    assert recording.remarks == ()


def test_a_key_nobody_knows_is_said_not_to_be_read(write: Write) -> None:
    path = write(good())
    path.with_suffix(".yaml").write_text(
        "weather: rain\nruns: {h0.10: {kind: isometric, knd: step}}\n"
    )
    remark, of_run = read_recording(path).remarks
    assert "weather is not read" in remark
    assert "runs.h0.10.knd is not read" in of_run


@pytest.mark.parametrize(
    ("text", "detail"),
    [
        ("muscle_serial: [A7, A8]", "rig.yaml:1: muscle_serial: "),
        ("rig: x\nrest_length_mm: [225, 274]", "rig.yaml:2: rest_length_mm: "),
        ("noise: {force: 5}", 'no such column; did you mean "force_N"?'),
        ("noise:\n  force_N: -5", "rig.yaml:2: noise.force_N: -5 is not above 0 N"),
        ("noise: {force_N: much}", '"much" is not above 0 N'),
        ("noise: {force_N: 1.0e+300}", "1e+300 is above 1e+12 N"),
        ("noise: {force_N: 4e+5}", "400000 N is above "),
        ("noise: {t_s: 1}", "rig.yaml:1: noise.t_s: the clock is taken for exact"),
        ("noise: 5", "rig.yaml:1: noise: 5 is not a mapping"),
        ("runs: {h0.1: {kind: step}}", 'no such run; did you mean "h0.10"?'),
        ("runs: {h0.10: {kind: isometrc}}", 'did you mean "isometric"?'),
        ("runs: [h0.10]", "rig.yaml:1: runs: "),
        ("runs: {", "rig.yaml:"),
        ("rig: a\nrig: b", "rig.yaml:2: rig: stands twice"),
        ("- 1", "is not a mapping"),
    ],
)
def test_a_side_file_that_cannot_be_right_is_refused(
    write: Write, complaint: Complaint, text: str, detail: str
) -> None:
    path = write(good())
    path.with_suffix(".yaml").write_text(text)
    assert detail in complaint(path)


def test_a_link_to_nothing_is_no_side_file(write: Write, complaint: Complaint) -> None:
    path = write(good())
    path.with_suffix(".yaml").symlink_to("rig.yaml")
    assert "rig.yaml: is a link to no file" in complaint(path)
