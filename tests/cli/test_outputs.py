"""What a diagnosis is told to write never takes the place of what it reads."""

import os
from collections.abc import Callable
from pathlib import Path

import pytest

from gripperd.cli.outputs import check_outputs
from gripperd.errors import InputError
from tests.daemon import gripperd

MODEL = (
    "name: drawn\nmuscle: {rest_length_mm: 250, diameter_mm: 20, braid_angle_deg: 25,"
    " wall_thickness_mm: 2, elastic_modulus_MPa: 1.3, friction_coefficient: 0.002}\n"
)


@pytest.mark.parametrize(
    ("asked", "complaint"),
    [
        (["--report", "rec.csv"], "is the recording; name another file for --report"),
        (["--json", "model.yaml"], "is the model; name another file for --json"),
        (["--json", "set.yaml", "--config", "set.yaml"], "is the configuration; name"),
        (["--json", "rec.yaml"], "is the side file of the recording; name another"),
        (["--json", "x", "--report", "x"], "is the file for --json; name another file"),
        (["--report", "/proc/x.html"], "/proc/x.html: cannot be written"),
    ],
)
def test_a_file_that_must_not_be_written_is_told_before_the_work(
    tmp_path: Path, asked: list[str], complaint: str
) -> None:
    # It would be refused as a recording: nothing was read of it yet.
    (tmp_path / "rec.csv").write_text("no recording")
    (tmp_path / "model.yaml").write_text(MODEL)
    places = [each if each[0] in "-/" else str(tmp_path / each) for each in asked]
    ended = gripperd(
        "diagnose", str(tmp_path / "rec.csv"), *places,
        "--model", str(tmp_path / "model.yaml"),
    )  # fmt: skip
    assert ended.returncode == 2
    assert complaint in ended.stderr
    assert ended.stdout == ""
    assert sorted(one.name for one in tmp_path.iterdir()) == ["model.yaml", "rec.csv"]
    assert (tmp_path / "rec.csv").read_text() == "no recording"
    assert (tmp_path / "model.yaml").read_text() == MODEL


@pytest.mark.parametrize("link", [os.symlink, os.link])
def test_another_name_of_an_input_is_the_input(
    tmp_path: Path, link: Callable[[Path, Path], None]
) -> None:
    recording, other = tmp_path / "rec.csv", tmp_path / "found.html"
    recording.write_text("kept")
    link(recording, other)
    with pytest.raises(InputError, match="is the recording") as refused:
        check_outputs({"--report": other}, {"the recording": recording})
    assert refused.value.key == "--report"
    assert recording.read_text() == "kept"


def test_links_that_lead_round_in_a_circle_are_no_trouble(tmp_path: Path) -> None:
    one, other = tmp_path / "one.csv", tmp_path / "other.csv"
    one.symlink_to(other)
    other.symlink_to(one)
    check_outputs({"--json": tmp_path / "found.json"}, {"the recording": one})
    with pytest.raises(InputError, match="cannot be written"):
        check_outputs({"--json": one}, {"the recording": tmp_path / "rec.csv"})


def test_a_check_leaves_everything_as_it_was(tmp_path: Path) -> None:
    old, link, new = tmp_path / "old", tmp_path / "link", tmp_path / "new"
    old.write_text("old")
    link.symlink_to(tmp_path / "not there yet")
    check_outputs({"a": old, "b": link, "c": new}, {})
    assert old.read_text() == "old"
    assert sorted(one.name for one in tmp_path.iterdir()) == ["link", "old"]
