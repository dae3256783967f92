from dataclasses import dataclass
from pathlib import Path

import pytest

from gripperd.errors import NotFound, Refused
from gripperd.store.records import FILE, Records

ID, OTHER = "a" * 32, "0123456789abcdef" * 4


@dataclass(frozen=True)
class Note:
    text: str


@pytest.fixture
def records(tmp_path: Path) -> Records[Note]:
    return Records(tmp_path / "notes", Note, "note")


def test_what_was_written_is_read_again_in_another_life(
    records: Records[Note],
) -> None:
    records.put(ID, Note("first"))
    records.put(OTHER, Note("second"))
    records.put(ID, Note("third"))
    again = Records(records.folder, Note, "note")
    assert again.get(ID) == Note("third")
    assert {note.text for note in again.all()} == {"second", "third"}


def test_nothing_was_written_yet(records: Records[Note]) -> None:
    assert list(records.all()) == []
    with pytest.raises(NotFound, match=f"there is no note '{ID}'"):
        records.get(ID)


@pytest.mark.parametrize("name", ["..", "../x", "A" * 32, "a" * 31, "", "a" * 65])
def test_what_is_no_id_names_no_folder(records: Records[Note], name: str) -> None:
    (records.folder.parent / FILE).write_text('{"text": "outside"}')
    with pytest.raises(NotFound):
        records.get(name)
    with pytest.raises(NotFound):
        records.place(name)


def test_a_damaged_record_costs_only_itself(records: Records[Note]) -> None:
    records.put(ID, Note("first"))
    records.put(OTHER, Note("second"))
    (records.place(ID) / FILE).write_text('{"text": 1')
    assert [note.text for note in records.all()] == ["second"]
    with pytest.raises(NotFound):
        records.get(ID)


def test_a_disk_that_does_not_take_it_is_a_refusal(tmp_path: Path) -> None:
    (tmp_path / "notes").write_text("in the way")
    with pytest.raises(Refused, match="nothing was kept") as refused:
        Records(tmp_path / "notes", Note, "note").put(ID, Note("first"))
    assert refused.value.code == "storage-failed"
