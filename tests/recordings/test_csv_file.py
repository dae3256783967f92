from pathlib import Path

import pytest

from gripperd.recordings import read_recording
from tests.recordings.conftest import Complaint, Write, good


def test_text_in_a_column_of_numbers_is_refused_with_line_and_column(
    write: Write, complaint: Complaint
) -> None:
    columns = good()
    columns["force_N"][7] = "broken"
    message = complaint(write(columns))
    assert message == 'rig.csv:9: force_N: "broken" is not a number'


def test_lines_are_counted_with_the_empty_ones(
    write: Write, complaint: Complaint
) -> None:
    columns = good()
    columns["force_N"][7] = "broken"
    path = write(columns)
    path.write_text("\n" + path.read_text().replace("\n", "\n\n", 3))
    assert complaint(path).startswith("rig.csv:13: force_N")


@pytest.mark.parametrize("separator", [";", "\t"])
def test_other_separators_are_named(
    write: Write, complaint: Complaint, separator: str
) -> None:
    path = write(good())
    path.write_text(path.read_text().replace(",", separator).replace(".", ","))
    message = complaint(path)
    assert message.startswith("rig.csv:1: cells are separated by ")
    assert "commas" in message
    assert "point" in message


def test_a_decimal_comma_in_quotes_is_explained(
    write: Write, complaint: Complaint
) -> None:
    columns = good()
    columns["force_N"][0] = '"12,5"'
    message = complaint(write(columns))
    assert message.startswith('rig.csv:2: force_N: "12,5" is not a number; write dec')


def test_a_cell_as_long_as_a_file_is_told_at_once(
    write: Write, complaint: Complaint
) -> None:
    """A pattern that goes back over its digits takes seven minutes for so many."""
    columns = good()
    columns["force_N"][0] = "9" * 120_000 + "x"
    said = complaint(write(columns))
    assert said.startswith('rig.csv:2: force_N: "999')
    assert "is not a number" in said
    assert len(said) < 300


def test_a_line_with_too_many_cells_is_refused(
    write: Write, complaint: Complaint
) -> None:
    columns = good()
    columns["force_N"][2] = "12,5"
    assert complaint(write(columns)) == "rig.csv:4: 6 cells under 5 names"


def test_a_file_cut_off_in_a_line_is_refused(
    write: Write, complaint: Complaint
) -> None:
    path = write(good())
    path.write_text(path.read_text()[:-12])
    assert complaint(path).startswith("rig.csv:31: ")


def test_lines_are_counted_with_those_inside_quotes(
    write: Write, complaint: Complaint
) -> None:
    columns = good() | {"note": [""] * 30}
    columns["note"][2] = '"on two\nlines, with ""marks"""'
    columns["force_N"][7] = "broken"
    message = complaint(write(columns))
    assert message == 'rig.csv:10: force_N: "broken" is not a number'


def test_a_quote_that_never_closes_is_told_with_its_line(
    write: Write, complaint: Complaint
) -> None:
    """What follows would be one long cell, and all of its rows lost."""
    columns = good() | {"note": [""] * 30}
    columns["note"][4] = '2" hose'
    columns["note"][22] = '"begun'
    path = write(columns)
    path.write_text(path.read_text() + "\n")
    assert complaint(path) == "rig.csv:24: a quote opens and never closes"


def test_a_mark_inside_a_cell_is_no_quote(write: Write) -> None:
    columns = good() | {"note": [""] * 30}
    columns["note"][4] = '2" hose'
    (run,) = read_recording(write(columns)).runs
    assert len(run) == 30


def test_a_line_that_is_not_utf_8_is_named(write: Write, complaint: Complaint) -> None:
    columns = good()
    columns["run"] = ["Öl"] * 30
    path = write(columns)
    path.write_bytes(path.read_text().encode("latin-1"))
    assert complaint(path) == "rig.csv:2: is not UTF-8 text; save it as such"


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("\n", "\r\n"),
        ("\n", "\r"),
        ("\n", "\n\n"),
        (",", ", "),
        ("run,", "\n\nrun,"),
        ("h0.10", '"h0.10"'),
    ],
)
def test_other_ways_to_write_the_same_read_the_same(
    write: Write, tmp_path: Path, old: str, new: str
) -> None:
    path = write(good())
    other = tmp_path / "other.csv"
    other.write_bytes(path.read_text().replace(old, new).encode("utf-8-sig"))
    (run,), (same,) = read_recording(path).runs, read_recording(other).runs
    assert same.name == run.name
    assert {key: list(values) for key, values in same.columns.items()} == {
        key: list(values) for key, values in run.columns.items()
    }
