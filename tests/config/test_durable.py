import os
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from types import FrameType

import pytest
import yaml
from hypothesis import example, given
from hypothesis import strategies as st

from gripperd.config.document import read_document
from gripperd.config.durable import create_file, replace_file
from gripperd.config.text import yaml_text


def names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def test_a_file_that_is_there_is_never_overwritten(tmp_path: Path) -> None:
    file = tmp_path / "1.yaml"
    create_file(file, "old", check=Path.read_text)
    with pytest.raises(FileExistsError):
        create_file(file, "new", check=Path.read_text)
    assert (file.read_text(), names(tmp_path)) == ("old", ["1.yaml"])


def test_a_file_gets_its_name_only_once_it_is_found_good(tmp_path: Path) -> None:
    def refuse(draft: Path) -> None:
        assert draft.read_text() == "half"
        assert not (tmp_path / "1.yaml").exists()
        raise LookupError

    with pytest.raises(LookupError):
        create_file(tmp_path / "1.yaml", "half", check=refuse)
    assert names(tmp_path) == []


def test_who_reads_while_it_is_replaced_has_the_old_file_whole(tmp_path: Path) -> None:
    file = tmp_path / "active.yaml"
    replace_file(file, "old")
    with file.open() as reader:
        replace_file(file, "new")
        assert reader.read() == "old"
    assert (file.read_text(), names(tmp_path)) == ("new", ["active.yaml"])


def test_a_longer_draft_left_by_a_power_cut_leaves_nothing_behind(
    tmp_path: Path,
) -> None:
    (tmp_path / ".active.draft").write_text("what was longer than the new file")
    replace_file(tmp_path / "active.yaml", "new")
    assert (tmp_path / "active.yaml").read_text() == "new"
    assert names(tmp_path) == ["active.yaml"]


def asked_of_the_system(work: Callable[[], None]) -> Sequence[str]:
    """Names of the calls that decide what a power cut leaves, in their order."""
    calls: list[str] = []

    def look(_: FrameType, event: str, call: object) -> None:
        name = getattr(call, "__name__", "")
        if event == "c_call" and name in {"fsync", "rename", "replace", "link"}:
            calls.append(name)

    before = sys.getprofile()
    sys.setprofile(look)
    try:
        work()
    finally:
        sys.setprofile(before)
    return calls


def test_a_name_is_given_to_what_is_on_the_disk_and_is_there_to_stay(
    tmp_path: Path,
) -> None:
    (tmp_path / "there.yaml").write_text("old")
    replaced = asked_of_the_system(lambda: replace_file(tmp_path / "there.yaml", "new"))
    assert replaced in (["fsync", "replace", "fsync"], ["fsync", "rename", "fsync"])
    created = asked_of_the_system(
        lambda: create_file(tmp_path / "1.yaml", "new", check=Path.read_text)
    )
    assert created == ["fsync", "link", "fsync"]


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_a_folder_that_may_not_be_written_keeps_the_old_file(tmp_path: Path) -> None:
    file = tmp_path / "active.yaml"
    replace_file(file, "old")
    tmp_path.chmod(0o500)
    with pytest.raises(PermissionError):
        replace_file(file, "new")
    assert file.read_text() == "old"


SCALARS = (
    st.text()
    | st.integers(-(10**15), 10**15)
    | st.floats(allow_nan=False, allow_infinity=False)
    | st.booleans()
)


@example({"a": "one line\x85another\u2028third"})
@given(
    st.dictionaries(
        st.from_regex(r"[a-z_]{1,9}", fullmatch=True), SCALARS | st.lists(SCALARS)
    )
)
def test_what_is_written_is_read_by_us_and_by_others(
    tmp_path_factory: pytest.TempPathFactory, value: dict[str, object]
) -> None:
    path = tmp_path_factory.mktemp("text") / "f.yaml"
    text = yaml_text(value)
    path.write_text(text, encoding="utf-8")
    document = read_document(path)
    assert (document.value, document.complaints) == (value, ())
    assert yaml.safe_load(text) == value
