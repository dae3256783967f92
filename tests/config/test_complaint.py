import pickle
from pathlib import Path

import pytest

from gripperd.config.complaint import Complaint, did_you_mean, gathering, printable
from gripperd.config.document import read_document


def test_a_complaint_is_one_line_with_file_line_and_key() -> None:
    complaint = Complaint(
        "1 kPa is above 0 kPa",
        source="a.yaml",
        line=7,
        path=("valve", "pressure_kPa", 1),
    )
    assert complaint == "a.yaml:7: valve.pressure_kPa[1]: 1 kPa is above 0 kPa"


def test_a_complaint_without_file_starts_with_the_key() -> None:
    complaint = Complaint("is missing", path=("grasp", "mode"))
    assert complaint == "grasp.mode: is missing"


def test_a_complaint_about_a_whole_file_has_no_key() -> None:
    assert Complaint("is not a file", source="a.yaml") == "a.yaml: is not a file"


def test_a_pointer_escapes_as_rfc_6901_says() -> None:
    assert Complaint("?", path=("a/b", "m~n", 0)).pointer == "/a~1b/m~0n/0"
    assert Complaint("?").pointer == ""


def test_a_complaint_survives_the_way_to_another_process() -> None:
    complaint = Complaint("is missing", source="a.yaml", line=3, path=("x",))
    copy = pickle.loads(pickle.dumps(complaint))
    assert (copy, copy.pointer, copy.detail) == (complaint, "/x", "is missing")


def test_what_moves_the_cursor_of_a_terminal_is_escaped() -> None:
    assert printable("a\x1b[2Jb\n\ud800°") == r"a\x1b[2Jb\n\ud800°"


def test_a_long_text_is_cut_to_sixty_characters() -> None:
    assert printable("x" * 10_000) == "x" * 57 + "..."
    assert printable("x" * 60) == "x" * 60


def test_a_near_miss_is_named_and_else_everything_there_is() -> None:
    known = ["diameter_mm", "mass_g"]
    assert did_you_mean("diamter_mm", known) == 'did you mean "diameter_mm"?'
    assert did_you_mean("zzz", known) == "there are: diameter_mm, mass_g"
    assert did_you_mean("zzz", []) == "there are none"


def test_gathering_goes_on_after_a_complaint_but_not_after_a_defect() -> None:
    complaints: list[str] = []
    for broken in (Path("gone.yaml"), Path("lost.yaml")):
        with gathering(complaints):
            read_document(broken)
    assert complaints == [
        "gone.yaml: there is no such file",
        "lost.yaml: there is no such file",
    ]
    with pytest.raises(ValueError, match="could not convert"), gathering(complaints):
        float("defect")
